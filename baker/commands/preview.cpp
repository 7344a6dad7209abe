#include "baker/commands/preview.h"

#include <fmt/format.h>

#include <set>

#include "baker/commands/command_line.h"
#include "baker/commands/preview_bake.h"
#include "baker/core/file.h"
#include "baker/preview/embedded.h"

namespace ft::inline baker {
namespace {

void replace(std::string& page, std::string_view mark, std::string_view text) {
  const std::size_t place = page.find(mark);
  CHECK(place != std::string::npos);
  page.replace(place, mark.size(), text);
}

std::string escape_html(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

/// What to call bakes on one page: the last parts of their paths, as many as tell them apart.
std::vector<std::string> names_of(std::span<const std::filesystem::path> folders) {
  std::vector<std::filesystem::path> rest;
  std::error_code ignored;
  for (const auto& folder : folders)
    rest.push_back(std::filesystem::absolute(folder / "", ignored).lexically_normal().parent_path());
  std::vector<std::string> out(folders.size());
  const auto repeated = [&] { return std::set<std::string>(out.begin(), out.end()).size() < out.size(); };
  do
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = rest[i].filename().string() + (out[i].empty() ? "" : "/" + out[i]);
      rest[i] = rest[i].parent_path();
    }
  while (repeated() && rest.front().has_filename());
  return out;
}

}  // namespace

Result<std::string> preview_page(std::span<const std::filesystem::path> bake_folders) {
  CHECK(!bake_folders.empty());
  const std::vector<std::string> names = names_of(bake_folders);
  Json page_data{{"bakes", Json::array()}};
  for (std::size_t i = 0; i < bake_folders.size(); ++i) {
    auto bake = preview_bake(bake_folders[i]);
    if (!bake) return bake.error();
    (*bake)["name"] = names[i];
    page_data["bakes"].push_back(std::move(*bake));
  }
  std::string data = page_data.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t place = 0; (place = data.find("</", place)) != std::string::npos; place += 3)
    data.replace(place, 2, "<\\/");

  std::string page(embedded_page());
  replace(page, "%TITLE%", escape_html(page_data["bakes"][0]["shot"].get<std::string>()));
  replace(page, "%STYLE%", embedded_style());
  replace(page, "%PLOTS%", embedded_plots());
  replace(page, "%PATHS%", embedded_paths());
  replace(page, "%INSTANCES%", embedded_instances());
  replace(page, "%WIND%", embedded_wind());
  replace(page, "%PLAYER%", embedded_player());
  replace(page, "%CONTROLS%", embedded_controls());
  replace(page, "%THREE%", embedded_three());
  replace(page, "%BAKE%", data);
  return page;
}

int run_preview(const PreviewOptions& options) {
  const auto page = preview_page(options.folders);
  if (!page) {
    complain(page.error().text());
    return exit_code(page.error().kind);
  }
  const auto output = options.output.empty() ? options.folders.front() / "preview.html" : options.output;
  if (const Status written = write_text_durably(output, *page); !written) {
    complain(written.error().text());
    return exit_code(written.error().kind);
  }
  fmt::print("preview: {} ({:.1f} MB)\n", output.string(), 1e-6 * static_cast<double>(page->size()));
  return 0;
}

}  // namespace ft::inline baker

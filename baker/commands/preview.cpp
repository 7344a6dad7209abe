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

Result<PreviewPage> preview_page(const PreviewOptions& options) {
  CHECK(!options.folders.empty());
  const std::vector<std::string> names = names_of(options.folders);
  const double curve_bytes = 1e6 * options.curve_megabytes / static_cast<double>(options.folders.size());
  PreviewPage out;
  Json page_data{{"bakes", Json::array()}};
  for (std::size_t i = 0; i < options.folders.size(); ++i) {
    auto bake = preview_bake(options.folders[i], curve_bytes);
    if (!bake) return bake.error();
    (*bake)["name"] = names[i];
    for (const Json& system : (*bake)["systems"])
      if (system.contains("curves") && system["curves"].contains("note"))
        out.notes.push_back((names.size() > 1 ? names[i] + ": " : std::string()) +
                            system["curves"]["note"].get<std::string>());
    page_data["bakes"].push_back(std::move(*bake));
  }
  std::string data = page_data.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t place = 0; (place = data.find("</", place)) != std::string::npos; place += 3)
    data.replace(place, 2, "<\\/");

  std::string& page = out.text;
  page = embedded_page();
  replace(page, "%TITLE%", escape_html(page_data["bakes"][0]["shot"].get<std::string>()));
  replace(page, "%STYLE%", embedded_style());
  replace(page, "%PLOTS%", embedded_plots());
  replace(page, "%PATHS%", embedded_paths());
  replace(page, "%INSTANCES%", embedded_instances());
  replace(page, "%CURVES%", embedded_curves());
  replace(page, "%POINTS%", embedded_points());
  replace(page, "%WIND%", embedded_wind());
  replace(page, "%WATER%", embedded_water());
  replace(page, "%PLAYER%", embedded_player());
  replace(page, "%CONTROLS%", embedded_controls());
  replace(page, "%THREE%", embedded_three());
  replace(page, "%BAKE%", data);
  return out;
}

int run_preview(const PreviewOptions& options) {
  const auto page = preview_page(options);
  if (!page) {
    complain(page.error().text());
    return exit_code(page.error().kind);
  }
  const auto output = options.output.empty() ? options.folders.front() / "preview.html" : options.output;
  if (const Status written = write_text_durably(output, page->text); !written) {
    complain(written.error().text());
    return exit_code(written.error().kind);
  }
  for (const std::string& note : page->notes) fmt::print("note: {}\n", note);
  fmt::print("preview: {} ({:.1f} MB)\n", output.string(), 1e-6 * static_cast<double>(page->text.size()));
  return 0;
}

}  // namespace ft::inline baker

#include "io/reading/numbered_files.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace ft::inline io {

Result<NumberedFiles> numbered_files(const std::filesystem::path& named, std::string_view prefix,
                                     std::string_view suffix) {
  std::vector<std::pair<std::int64_t, std::filesystem::path>> found;
  std::error_code failed;
  const auto folder = named.parent_path().empty() ? std::filesystem::path(".") : named.parent_path();
  for (std::filesystem::directory_iterator entry(folder, failed), last; !failed && entry != last;
       entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    const std::string digits = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    if (digits.size() > 12 || !std::all_of(digits.begin(), digits.end(),
                                           [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }))
      continue;
    found.push_back({std::stoll(digits), named.parent_path() / name});
  }
  if (found.empty()) return input_error("no file of this sequence exists", named.string());
  std::sort(found.begin(), found.end());
  NumberedFiles out;
  out.first = found.front().first;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i > 0 && found[i].first != found[i - 1].first + 1)
      return input_error(
          "number " + std::to_string(found[i - 1].first + 1) + " is missing from the sequence, or is there twice",
          named.string());
    out.files.push_back(found[i].second);
  }
  return out;
}

}  // namespace ft::inline io

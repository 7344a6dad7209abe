#include "io/shot/patterns.h"

#include <algorithm>

#include "io/shot/shot_values.h"
#include "io/shot/words.h"

namespace ft::inline io {

Result<std::vector<int>> indices_like(std::span<const std::string> patterns, std::span<const std::string> names,
                                      std::string_view key, std::string_view what) {
  std::vector<int> out;
  for (const std::string& pattern : patterns) {
    const std::size_t before = out.size();
    for (std::size_t i = 0; i < names.size(); ++i)
      if (matches(pattern, names[i])) out.push_back(static_cast<int>(i));
    if (out.size() > before) continue;
    std::string word = pattern;
    std::erase_if(word, [](char c) { return c == '*' || c == '?'; });
    return usage_error(
        std::string(key).append(" = ").append(in_quotes(printable(pattern))).append(" names no ").append(what), {},
        suggestion(word, names));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace ft::inline io

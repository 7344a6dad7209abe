// Names in a message, and compared.
#pragma once

#include <string>

namespace ft::inline io {

/// "a", "b" and so on in quotes, at most eight of them, then how many more there are.
template <class Names>
std::string name_list(const Names& names) {
  constexpr std::size_t k_most = 8;
  std::string out;
  std::size_t listed = 0;
  for (const std::string& name : names) {
    if (listed++ == k_most) return out + ", and " + std::to_string(names.size() - k_most) + " more";
    out += (out.empty() ? "\"" : ", \"") + name + "\"";
  }
  return out;
}

/// A to Z in small letters.
inline std::string small_letters(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace ft::inline io

#include "io/shot/obj_words.h"

#include <charconv>
#include <cstdlib>

namespace ft::inline io {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_blank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

bool parse_number(std::string_view word, double& out) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), out);
  if (end != word.data() + word.size() || word.empty()) return false;
  // Too small or too large for a double: strtod tells which (0 or infinity).
  if (fault == std::errc::result_out_of_range) out = std::strtod(std::string(word).c_str(), nullptr);
  return fault == std::errc{} || fault == std::errc::result_out_of_range;
}

bool parse_index(std::string_view word, long long& out) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), out);
  return !word.empty() && fault == std::errc{} && end == word.data() + word.size();
}

std::string shown(std::string_view word) {
  std::string out;
  for (const char c : word.substr(0, 24)) out.push_back(c >= 32 && c < 127 ? c : '?');
  return word.size() > 24 ? out + "..." : out;
}

}  // namespace ft::inline io

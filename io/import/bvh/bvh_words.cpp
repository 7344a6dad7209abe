#include "io/import/bvh/bvh_words.h"

#include <charconv>
#include <cmath>

namespace ft::inline io {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

bool is_valid_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t more = lead < 0x80                   ? 0
                             : lead >= 0xf0 && lead < 0xf5 ? 3
                             : lead >= 0xe0                ? 2
                             : lead >= 0xc2                ? 1
                                                           : 9;
    if (more == 9 || lead >= 0xf5 || i + more >= text.size()) return false;
    for (std::size_t k = 1; k <= more; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    const auto second = more > 0 ? static_cast<unsigned char>(text[i + 1]) : 0u;
    const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
    const bool surrogate = lead == 0xed && second > 0x9f, beyond = lead == 0xf4 && second > 0x8f;
    if (overlong || surrogate || beyond) return false;
    i += more + 1;
  }
  return true;
}

}  // namespace

void BvhWords::skip_blanks() {
  for (; at_ < text_.size() && is_blank(text_[at_]); ++at_)
    if (text_[at_] == '\n' || (text_[at_] == '\r' && !text_.substr(at_ + 1).starts_with('\n'))) ++line_;
}

std::string_view BvhWords::next_number() {
  skip_blanks();
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string_view BvhWords::next() {
  skip_blanks();
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_blank(text_[at_])) {
    const bool brace = text_[at_] == '{' || text_[at_] == '}';
    if (brace && at_ > begin) break;
    ++at_;
    if (brace) break;
  }
  return text_.substr(begin, at_ - begin);
}

std::string_view BvhWords::next_before_colon() {
  skip_blanks();
  while (at_ < text_.size() && text_[at_] == ':') ++at_, skip_blanks();
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != ':') ++at_;
  const std::string_view word = text_.substr(begin, at_ - begin);
  if (at_ < text_.size() && text_[at_] == ':') ++at_;
  return word;
}

std::string_view BvhWords::rest_of_line() {
  std::size_t begin = at_;
  while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r' && text_[at_] != '{') ++at_;
  std::size_t end = at_;
  while (begin < end && is_blank(text_[begin])) ++begin;
  while (begin < end && is_blank(text_[end - 1])) --end;
  return text_.substr(begin, end - begin);
}

bool is_keyword(std::string_view word, std::string_view keyword) {
  if (word.size() != keyword.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != keyword[i]) return false;
  }
  return true;
}

bool read_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.starts_with("+") || (word.starts_with("-") && word.substr(1).starts_with('+'))) return false;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return false;
  if (fault == std::errc::result_out_of_range && word.find_first_of("eE") != std::string_view::npos &&
      word.substr(word.find_first_of("eE") + 1).starts_with('-')) {
    value = 0;  // too small for a double
    return true;
  }
  return fault == std::errc() && std::isfinite(value);
}

bool read_number(std::string_view word, std::size_t& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  return fault == std::errc() && end == word.data() + word.size();
}

std::string utf8_name(std::string_view name) {
  if (is_valid_utf8(name)) return std::string(name);
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out.push_back(c);
    } else {
      out.push_back(static_cast<char>(0xc0 | (byte >> 6)));
      out.push_back(static_cast<char>(0x80 | (byte & 0x3f)));
    }
  }
  return out;
}

}  // namespace ft::inline io

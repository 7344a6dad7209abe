// The words of a BVH: braces stand for themselves, all else is parted by blanks. Lines are counted as editors do, with
// any of the three line ends. Keywords are known in any case.
#pragma once

#include <string>
#include <string_view>

namespace ft::inline io {

class BvhWords {
 public:
  explicit BvhWords(std::string_view text) : text_(text) {}
  /// The next word; empty at the end.
  std::string_view next();
  /// The next word of the lines "Frames: 30" and "Frame Time: 0.04", where a colon parts words, too.
  std::string_view next_before_colon();
  /// What is left of the line, or of it before a brace, without blanks around it. Joints' names have blanks within.
  std::string_view rest_of_line();
  /// The next word that no brace parts: a number, in the fast loop over the motion.
  std::string_view next_number();
  int line() const { return line_; }  ///< of the last word, from 1

 private:
  void skip_blanks();

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Without regard to case; keyword is in small letters.
bool is_keyword(std::string_view word, std::string_view keyword);

/// A finite number, as C reads it in any of its spellings but nan, inf and hexadecimal.
bool read_number(std::string_view word, double& value);
bool read_number(std::string_view word, std::size_t& value);

/// The same text in UTF-8: what is not valid as such is taken for Latin-1.
std::string utf8_name(std::string_view name);

}  // namespace ft::inline io

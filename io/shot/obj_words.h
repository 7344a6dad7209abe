// Words and numbers of an OBJ's lines.
#pragma once

#include <string>
#include <string_view>

namespace ft::inline io {

bool is_blank(char c);
/// Cuts the next word off the front of `line`; empty at the end.
std::string_view next_word(std::string_view& line);
/// A number too small or too large for a double is 0 or infinity.
bool parse_number(std::string_view word, double& out);
bool parse_index(std::string_view word, long long& out);
/// A word of a file inside a message: printable and short.
std::string shown(std::string_view word);

}  // namespace ft::inline io

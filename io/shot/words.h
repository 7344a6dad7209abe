// What was probably meant: nearest word by edit distance, for every message that refuses a name. For all readers of
// user text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ft::inline io {

/// Insertions, deletions, substitutions and swaps of neighbours (optimal string alignment); case, '-' and '_' do not
/// count.
int edit_distance(std::string_view a, std::string_view b);

/// The nearest candidate, when it is near enough to be a slip of the pen or one contains the other; else empty. Ties:
/// the first.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// `did you mean "denim"?`, or `known: cotton, denim, ...` when nothing is near; empty without candidates.
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

/// Whether a word is what a pattern says: `*` stands for any text, `?` for one character; case does not count.
bool matches(std::string_view pattern, std::string_view word);

std::string joined(std::span<const std::string> words, std::string_view separator = ", ");

/// Printable form of text from outside: control characters become '?', long text is cut.
std::string printable(std::string_view text, std::size_t longest = 60);

/// Shortest digits that name the same double.
std::string number_text(double value);

}  // namespace ft::inline io

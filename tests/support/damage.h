// Damaged input for the tests of readers: every cut, flipped bits, and random edits of a good text. What happens is a
// function of the seed, so that a failure comes back. A damage that every reader should survive belongs here; what one
// format alone can suffer (a length that lies) stays with its test.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "baker/core/bytes.h"
#include "baker/core/random.h"

namespace ft::test {

/// visit(bytes, size) for every beginning of the bytes that is shorter than they are.
template <class Visit>
void for_each_cut(std::span<const std::byte> bytes, Visit&& visit) {
  for (std::size_t size = 0; size < bytes.size(); ++size) visit(bytes.first(size), size);
}

/// visit(bytes, bit) with every bit flipped in turn, alone.
template <class Visit>
void for_each_flipped_bit(Bytes bytes, Visit&& visit) {
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const std::byte mask{static_cast<unsigned char>(1u << bit % 8)};
    bytes[bit / 8] ^= mask;
    visit(std::as_const(bytes), bit);
    bytes[bit / 8] ^= mask;
  }
}

struct TextDamage {
  std::string_view alphabet;  ///< what is written over and between; write it as "..."sv where a NUL is in it
  std::uint64_t most_edits = 4;
  std::uint64_t most_erased = 25;  ///< characters, by one edit
};

/// The text after 1 to most_edits edits: a character written over, one put between, or a few taken out.
inline std::string damaged(std::string text, const TextDamage& damage, std::uint64_t seed) {
  std::uint64_t draws = 0;
  const auto draw = [&](std::uint64_t range) {
    return static_cast<std::size_t>(random_bits({.seed = seed}, draws++) % range);
  };
  for (std::size_t edits = 1 + draw(damage.most_edits); edits > 0; --edits) {
    const std::size_t place = draw(text.size() + 1), kind = draw(10);
    const char c = damage.alphabet[draw(damage.alphabet.size())];
    if (kind < 4 && place < text.size())
      text[place] = c;
    else if (kind < 7)
      text.insert(text.begin() + static_cast<std::ptrdiff_t>(place), c);
    else
      text.erase(place, 1 + draw(damage.most_erased));
  }
  return text;
}

}  // namespace ft::test

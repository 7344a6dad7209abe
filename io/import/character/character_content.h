// What a character's file holds, for who wants to know what became of it.
#pragma once

#include <cstdint>
#include <string>

namespace ft::inline io {

/// A kind of thing that a file holds, and what becomes of it.
struct CharacterContent {
  std::string what;        ///< plural, as the format calls it: "animation layers", "constraints"
  std::int64_t count = 0;  ///< of them in the file
  std::string use;         ///< "used", "not used: ..." with the reason
};

}  // namespace ft::inline io

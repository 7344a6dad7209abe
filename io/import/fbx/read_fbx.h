// FBX 7 (binary and text) -> Character, by our own reader. Runs in the importing child process.
#pragma once

#include "io/import/character/character.h"

namespace ft::inline io {

/// The bytes are freed as soon as they are read. The result is not checked yet (check_character). Files of version 6
/// and below, and big-endian ones, are refused by name.
Result<Character> read_fbx(Bytes data);

}  // namespace ft::inline io

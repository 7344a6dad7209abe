// The door to the readers of characters: a file becomes a Character. Runs in the importing child process only.
#pragma once

#include <filesystem>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Version of everything that turns file bytes into a Character; part of the import cache's key.
inline constexpr const char* k_importer_version = "import 3";

/// Picks the reader by what the file is. The result is not checked yet (check_character).
Result<Character> read_character(const std::filesystem::path& file);

}  // namespace ft::inline io

// The parent's side of the import: a guarded child process of this very program reads the file and hands over a
// Character.
#pragma once

#include <filesystem>

#include "io/import/character/character.h"
#include "io/import/import.h"

namespace ft::inline io {

/// Runs `/proc/self/exe --import-child file result` and checks what comes back. The program's main() must call
/// import_child_main() first.
Result<Character> import_in_child(const std::filesystem::path& file, const ImportLimits& limits);

}  // namespace ft::inline io

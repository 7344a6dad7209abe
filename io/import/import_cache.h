// Characters by the hash of their file: a second bake does not pay for the import. Entries are ignored, and written
// anew, when they are damaged, of another version, or when a file that the character refers to has changed.
#pragma once

#include <filesystem>

#include "io/import/character/character.h"
#include "io/import/import.h"

namespace ft::inline io {

struct LoadedCharacter {
  Character character;
  Hash128 content;  ///< of the file and all it refers to
  bool from_cache = false;
};

/// cache_folder may be empty: no cache. A cache that cannot be written is a note on the character, not a fault.
Result<LoadedCharacter> load_character(const std::filesystem::path& file, const std::filesystem::path& cache_folder,
                                       const ImportLimits& limits);

}  // namespace ft::inline io

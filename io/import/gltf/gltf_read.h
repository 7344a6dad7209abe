// The reader of glTF 2.0 (.gltf, .glb): a file becomes a Character by its JSON and accessors alone.
#pragma once

#include <filesystem>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Whether a file calls itself glTF: by its first bytes, or by its name.
bool is_gltf(const std::filesystem::path& file);
/// Whether it is of version 1, which read_gltf() refuses, and has neither skins nor animations.
bool is_still_gltf_1(const std::filesystem::path& file);

/// The result is not checked yet (check_character). Refuses what it cannot do with the name of it: an extension that
/// the file requires, an accessor that leaves its buffer, a node with two parents.
Result<Character> read_gltf(const std::filesystem::path& file);

}  // namespace ft::inline io

// Animations of a glTF file, read from its JSON and buffers directly: assimp drops the interpolation of samplers (steps
// and cubic splines became straight lines, up to 0.67 m wrong), and node names that occur twice.
#pragma once

#include <filesystem>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Replaces the clips and rest morph weights that assimp read. Where the file uses something that is not understood
/// here (sparse or compressed accessors) the clips stay as they are, with a note.
void read_gltf_clips(const std::filesystem::path& file, Character& character);

}  // namespace ft::inline io

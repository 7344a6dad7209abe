// Animations of a glTF as clips: keys with their interpolation, by node.
#pragma once

#include <vector>

#include "io/import/gltf/gltf_file.h"

namespace ft::inline io::gltf {

/// node_of: node of the character for each of the JSON (-1: not in the scene; its channels are left out). The nodes
/// have their morph weights already. Refuses keys that cannot be read, with the animation's name.
Status read_clips(GltfFile& file, const std::vector<int>& node_of, Character& out);

}  // namespace ft::inline io::gltf

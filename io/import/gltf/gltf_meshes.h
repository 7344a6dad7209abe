// Meshes of a glTF: one CharacterMesh per primitive and per use of its mesh by a node, with that node's skin.
#pragma once

#include <vector>

#include "io/import/gltf/gltf_file.h"

namespace ft::inline io::gltf {

/// node_of: node of the character for each of the JSON. Sets rest morph weights of the nodes, too.
Status read_meshes(GltfFile& file, const std::vector<int>& node_of, Character& out);

}  // namespace ft::inline io::gltf

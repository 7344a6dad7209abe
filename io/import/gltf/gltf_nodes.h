// The node tree of a glTF's scene, and which node of the character each node of the JSON became.
#pragma once

#include <vector>

#include "io/import/gltf/gltf_file.h"

namespace ft::inline io::gltf {

/// Adds the nodes of the default scene, parents first; returns the character's node for each of the JSON (-1: not in
/// the scene). Several roots get one above them, "ROOT". Trees outside of the scene that hold a joint of a skin in use
/// are added behind, with a note. Refuses circles, nodes with two parents, and indices of nothing.
Result<std::vector<int>> read_nodes(const Json& json, Character& out);

/// Node of the character for each node of the JSON (-1: not in the scene), by walking both trees side by side; empty
/// when the trees differ.
std::vector<int> match_nodes(const Json& json, const Character& character);

}  // namespace ft::inline io::gltf

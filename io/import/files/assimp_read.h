// The door to assimp: a file becomes a Character. Runs in the importing child process only, because a bad file can
// corrupt memory (measured with 5.2.5: 1 of 1,501 known-bad files). The types of assimp stop at assimp_*.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/import/character/character.h"

struct aiScene;
struct aiNode;
struct aiMesh;

namespace ft::inline io {

/// Reads the file and what it refers to. The result is not checked yet (check_character).
Result<Character> read_with_assimp(const std::filesystem::path& file);

/// Nodes as assimp gives them (parents first) and the node of ours that each became: FBX pivot chains
/// ("hips_$AssimpFbx$_Rotation" and so on) become one node, so that names match those of other files.
struct AssimpNodes {
  std::vector<const aiNode*> raw;
  std::vector<int> raw_parent;
  std::vector<int> node_of_raw;
  /// Raw nodes of one of ours, outermost first; the last one carries its name.
  std::vector<std::vector<int>> chain;
};

AssimpNodes read_nodes(const aiScene& scene, Character& out);
void read_meshes(const aiScene& scene, const AssimpNodes& nodes, Character& out);
void read_clips(const aiScene& scene, const AssimpNodes& nodes, Character& out);

}  // namespace ft::inline io

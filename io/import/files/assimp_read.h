// The door to assimp, for formats that have no reader of our own: a file becomes a Character. Runs in the importing
// child process only, because a bad file can corrupt memory (measured with 5.2.5: 1 of 1,501 known-bad files). The
// types of assimp stop at assimp_*.cpp.
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

/// Adds the nodes, parents first, and gives assimp's own in the same order.
std::vector<const aiNode*> read_nodes(const aiScene& scene, Character& out);
void read_meshes(const aiScene& scene, const std::vector<const aiNode*>& nodes, Character& out);
void read_clips(const aiScene& scene, const std::vector<const aiNode*>& nodes, Character& out);

}  // namespace ft::inline io

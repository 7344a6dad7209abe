// Garment meshes from OBJ, in the file's own vertex order (assimp would split shared vertices). Every fault is named.
#pragma once

#include <filesystem>

#include "baker/core/mesh.h"
#include "baker/core/result.h"

namespace ft {

/// Reads v, vt, f (negative and v/vt/vn indices), g/o (face groups become vertex groups), vertex colours (groups "red",
/// "green", "blue" with the channel as weight). Unknown lines are skipped.
Result<Mesh> read_obj(const std::filesystem::path& path);
Status write_obj(const std::filesystem::path& path, const Mesh& mesh);

/// Refuses what cannot be simulated: no faces, NaN or infinite vertices, zero-area faces, edges with more than two faces,
/// vertices used twice in a face, coincident vertices. One message with the count and the first places of each fault.
Status check_garment(const Mesh& mesh);

}  // namespace ft

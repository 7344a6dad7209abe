// Where the corners of a mesh's triangles are in its pattern.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "baker/core/mesh.h"

namespace ft {

/// Pattern coordinates of the corners of each triangle of triangulate(); empty when the mesh has none.
std::vector<std::array<Vec2, 3>> corner_uvs(const Mesh& mesh, std::span<const Triangle> triangles);

}  // namespace ft

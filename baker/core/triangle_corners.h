// How faces are split: the triangles of triangulate() (mesh.h) as corners, for what belongs to corners and not to
// vertices. What is simulated is what `check` judges, so both come from here.
#pragma once

#include <vector>

#include "baker/core/mesh.h"

namespace ft {

/// Places in face_vertices and face_uvs. Quads are split by the shorter diagonal, by that from the first corner where
/// both are as long; what has more corners as a fan from the first.
std::vector<Triangle> triangle_corners(const Mesh& mesh);

}  // namespace ft

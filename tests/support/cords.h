// Meshes whose edges make nets.
#pragma once

#include "baker/core/mesh.h"

namespace ft::test {

/// columns x rows unit quads in the plane z = 0, rows downwards; its first row of vertices is the group "top".
inline Mesh grid_of_quads(int columns, int rows) {
  Mesh out;
  out.name = "grid";
  VertexGroup& top = out.groups.emplace_back();
  top.name = "top";
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) out.positions.push_back(Vec3(i, -j, 0));
  for (int i = 0; i <= columns; ++i) top.vertices.push_back(i), top.weights.push_back(1);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int corner = j * (columns + 1) + i, below = corner + columns + 1;
      out.face_sizes.push_back(4);
      out.face_vertices.insert(out.face_vertices.end(), {corner, below, below + 1, corner + 1});
    }
  return out;
}

}  // namespace ft::test

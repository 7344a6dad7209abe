// Meshes whose edges make nets, and what holds for the strands of any.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "baker/core/mesh.h"
#include "solvers/cords/cord_graph.h"

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

inline double cosine_of_turn(const CordGraph& graph, const std::vector<int>& strand, std::size_t i) {
  const Vec3 before = graph.points[at(strand[i])] - graph.points[at(strand[i - 1])];
  const Vec3 after = graph.points[at(strand[i + 1])] - graph.points[at(strand[i])];
  return before.normalized().dot(after.normalized());
}

/// Every cord lies in one strand, once.
inline void expect_strands_hold_every_cord(const CordGraph& graph) {
  std::multiset<Edge> drawn;
  for (const auto& strand : graph.strands)
    for (std::size_t i = 0; i + 1 < strand.size(); ++i)
      drawn.insert({std::min(strand[i], strand[i + 1]), std::max(strand[i], strand[i + 1])});
  EXPECT_EQ(drawn, std::multiset<Edge>(graph.cords.begin(), graph.cords.end()));
  EXPECT_EQ(std::set<Edge>(graph.cords.begin(), graph.cords.end()).size(), graph.cords.size());
  for (const Edge& cord : graph.cords) EXPECT_LT(cord[0], cord[1]);
}

}  // namespace ft::test

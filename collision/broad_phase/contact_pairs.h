// Candidate pairs between features, over one numbering of all vertices: cloth vertices first [0, cloth_vertex_count),
// then the collider's. A stencil is four vertices; those at or past cloth_vertex_count are kinematic. Found by
// pair_finder.h, and kept by the numbers of the features where they are many (pair_list.h).
#pragma once

#include <array>
#include <compare>
#include <span>
#include <vector>

#include "baker/core/types.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::inline collision {

/// Vertex-face: v[0] is the vertex, v[1..3] the face. Edge-edge: v[0], v[1] one edge, v[2], v[3] the other.
struct Stencil {
  std::array<int, 4> v;
  bool operator==(const Stencil&) const = default;
  auto operator<=>(const Stencil&) const = default;
};

/// What the four vertices have of `from`.
inline std::array<Vec3, 4> gather(std::span<const Vec3> from, const Stencil& s) {
  return {from[at(s.v[0])], from[at(s.v[1])], from[at(s.v[2])], from[at(s.v[3])]};
}
inline std::array<Vec3, 4> gather(std::span<const Vec3f> from, const Stencil& s) {
  const auto of = [&](std::size_t k) { return from[at(s.v[k])].cast<double>(); };
  return {of(0), of(1), of(2), of(3)};
}

struct ContactPairs {
  std::vector<Stencil> vertex_face;
  std::vector<Stencil> edge_edge;

  bool empty() const { return vertex_face.empty() && edge_edge.empty(); }
};

}  // namespace ft::inline collision

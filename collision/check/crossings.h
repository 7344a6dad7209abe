// The certificate: exact edge-triangle crossings of a configuration (orientation predicates: double with an error
// bound, exact arithmetic where the bound does not decide). Touching counts as crossing.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"
#include "collision/check/checked_surface.h"
#include "collision/geometry/triangle_tree.h"

namespace ft::inline collision {

/// Sign of the volume of (a, b, c, d): exact. Positive when d is below the plane of a, b, c seen counter-clockwise from
/// above.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

bool edge_crosses_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);
/// Whether it crosses any of the triangles that a tree is over.
bool edge_crosses_any(const Vec3& p, const Vec3& q, const TriangleTree& tree, std::span<const Vec3> positions,
                      std::span<const Triangle> triangles);

struct Crossing {
  Edge edge;
  Triangle triangle;
  bool edge_of_first =
      true;  ///< crossings_between: the edge is of surface a, the triangle of b; false: the other way round
  auto operator<=>(const Crossing&) const = default;
};

/// Whether the second surface's feature has a vertex that is marked; nothing marked: no.
inline bool second_is_marked(const Crossing& c, std::span<const char> marked) {
  if (marked.empty()) return false;
  const auto is = [&](int v) { return marked[static_cast<std::size_t>(v)] != 0; };
  return c.edge_of_first ? is(c.triangle[0]) || is(c.triangle[1]) || is(c.triangle[2]) : is(c.edge[0]) || is(c.edge[1]);
}

/// Edges of either surface through triangles of the other; sorted. Vertex numbering as positions are given.
std::vector<Crossing> crossings_between(const CheckedSurface& a, const CheckedSurface& b);
std::vector<Crossing> crossings_between(std::span<const Vec3> positions_a, std::span<const Triangle> triangles_a,
                                        std::span<const Vec3> positions_b, std::span<const Triangle> triangles_b);
/// Within one surface; pairs that share a vertex are left out.
std::vector<Crossing> crossings_within(const CheckedSurface& surface);
std::vector<Crossing> crossings_within(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft::inline collision

// A second, independent opinion on the certificate's crossings: no code is shared with collision/check/crossings.cpp.
// Candidates come from a uniform grid instead of trees; the decision from signs in extended precision with an error
// bound, and where that does not decide, from rational arithmetic that computes the intersection itself instead of
// orientations. Exact; touching counts as crossing. For the torture scenes, where it looks at every frame. Slower than
// the certificate.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft {

/// Does the closed segment p q meet the closed triangle a b c? Triangles without area are the segments that they have
/// shrunk to.
bool exactly_meets(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

struct EdgeTriangle {
  Edge edge;
  Triangle triangle;
  auto operator<=>(const EdgeTriangle&) const = default;
};

/// Edges of the first surface that meet triangles of the second; sorted, once each.
std::vector<EdgeTriangle> exact_crossings(std::span<const Vec3> edge_positions, std::span<const Triangle> edge_surface,
                                          std::span<const Vec3> positions, std::span<const Triangle> triangles);
/// Edges of a surface that meet its own triangles, those that share a vertex left out; sorted, once each.
std::vector<EdgeTriangle> exact_own_crossings(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft

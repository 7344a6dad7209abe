// An independent second opinion on crossings_between(): FCL's own traversal (OBBRSS trees) and its own triangle test,
// sharing no code with crossings.cpp. For tests and for judging a bake; it knows nothing of exact arithmetic, so pairs
// that barely touch may be counted or not.
#pragma once

#include <cstddef>
#include <span>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft::inline collision {

/// Number of pairs of intersecting triangles, one of a and one of b.
std::size_t fcl_intersecting_pairs(std::span<const Vec3> positions_a, std::span<const Triangle> triangles_a,
                                   std::span<const Vec3> positions_b, std::span<const Triangle> triangles_b);

}  // namespace ft::inline collision

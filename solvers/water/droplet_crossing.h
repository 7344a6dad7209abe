// When and where a point that moves in a straight line goes into a triangle whose corners do, too, from its outside.
#pragma once

#include <array>
#include <optional>

#include "baker/core/types.h"

namespace ft::inline solvers {

struct MovingTriangle {
  std::array<Vec3, 3> from, to;  ///< its outside is where its corners are counter-clockwise [m]
};

struct DropletCrossing {
  double share = 2;                       ///< of the way, 0 to 1; 2: none
  Vec3 normal = Vec3::UnitY();            ///< unit, outwards, then
  std::array<double, 3> weight{1, 0, 0};  ///< barycentric, then
};

/// The first one. A point that begins behind the triangle by less than twice the skin [m] and goes deeper is in at
/// once. Triangles without area are met by nothing.
std::optional<DropletCrossing> crossing_inwards(const MovingTriangle& triangle, const Vec3& from, const Vec3& to,
                                                double skin);

}  // namespace ft::inline solvers

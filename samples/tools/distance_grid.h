// Signed distance to a body on a regular grid, exact near the surface: negative inside, +-band far away. For
// make_garments. Overlapping shells count as one body (inside where the winding number is not zero, by the vote of
// three axes; of open shells where the generalized one is above one half).
#pragma once

#include <vector>

#include "samples/tools/body_slices.h"

namespace ft::garments {

struct DistanceGrid {
  Vec3 origin = Vec3::Zero();
  double cell = 0;             ///< m
  std::array<int, 3> size{};   ///< nodes along x, y, z
  std::vector<double> values;  ///< m, x fastest

  int index(int x, int y, int z) const { return (z * size[1] + y) * size[0] + x; }
  Vec3 node(int x, int y, int z) const { return origin + cell * Vec3(x, y, z); }
  /// Trilinear; clamps to the grid.
  double value(const Vec3& p) const;
  Vec3 gradient(const Vec3& p) const;
};

/// The grid covers the box; band: distances are exact up to it [m].
DistanceGrid make_distance_grid(const Body& body, const Box& box, double cell, double band);

}  // namespace ft::garments

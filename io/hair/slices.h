// Slices of a piece of a hair mesh across its long way, and the line through their centres.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

struct MiddleLine {
  std::vector<Vec3> line;    ///< from where the way is 0 to where it is 1 [m]
  std::vector<double> ways;  ///< the way at each vertex of it, ascending
  double breadth = 0;        ///< mean width of a strip, mean diameter of a tube [m]
  double single_share = 0;   ///< of the slices, those in one part: rings and branches have more
  double closed_share = 0;   ///< of the slices, those that close: 1 for a tube
};

/// `ways`: long_way() of the piece. Cuts it into `slices` (at least 1).
MiddleLine middle_line(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                       std::span<const double> ways, int slices);

}  // namespace ft::inline io

// The part of a driven body that may meet the water in a frame: of a whole person, the feet.
#pragma once

#include <span>
#include <vector>

#include "solvers/water/water_body.h"

namespace ft::inline solvers {

struct DrivenNear {
  std::vector<Triangle> triangles;  ///< into the vertices below
  std::vector<Vec3> from, to;       ///< of those [m]
  std::vector<Vec3> places;         ///< as place() left them [m]

  /// Keeps the triangles that come below a height in the frame.
  DrivenNear(const DrivenBody& body, double below);
  /// Where they are at a share of the frame, 0 to 1.
  void place(double share);
  /// Of what is below a height at one of two shares: its box, and the largest speed, as distance over the frame [m].
  Box box_below(double height, double share0, double share1, double& farthest) const;
};

}  // namespace ft::inline solvers

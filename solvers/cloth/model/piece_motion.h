// A piece of a substep: in it the body advances with the cloth carried along, and then the cloth is solved for.
#pragma once

#include <vector>

#include "baker/core/types.h"

namespace ft::inline solvers {

/// Positions and motions of a piece: cloth first, then the body.
struct PieceMotion {
  std::vector<Vec3> start;        ///< m
  std::vector<Vec3> body_motion;  ///< per body vertex, to the end of the substep [m]
  std::vector<Vec3> carry;        ///< per cloth vertex, while it is planned [m]
  std::vector<Vec3f> all;         ///< carry, then body_motion; what the cloth really does [m]
  /// Per vertex: from the start to the middle of where the solve may put it; of the body its motion [m].
  std::vector<Vec3f> centre;
  std::vector<float> slack;  ///< per cloth vertex: how far the solve may put it from there [m]
};

}  // namespace ft::inline solvers

// What the shot file says of a cloth and its pins, and its solver takes as it is.
#pragma once

#include "baker/core/types.h"

namespace ft::inline solvers {

struct ClothSettings {
  double sewing_time = 0;   ///< s from the start of the pre-roll until its stitches are closed; 0: half of the pre-roll
  double thickness = 3e-3;  ///< contact begins at this distance from the body [m], 0.5e-3..10e-3
  double friction = 0.4;    ///< Coulomb, against the body [1], 0..2
  double self_friction = 0.3;  ///< among cloths [1], 0..2
  bool self_collision = true;
};

struct ClothPinSettings {
  double stiffness = 1e6;  ///< N/m3: spring per garment area and displacement. 1e5 loose, 1e6 firm, 1e8 hard
  double max_pull = 5e3;   ///< Pa: force limit per garment area; contact wins over pins
  /// Not zero: its vertices let go one after another in this direction, and take hold the other way round, the last of
  /// them when the pin's fade is over.
  Vec3 opens = Vec3::Zero();
};

}  // namespace ft::inline solvers

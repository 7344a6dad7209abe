// A point on a spring behind a target that moves: x'' = -w^2 (x - target) - 2 z w (x' - target'). Written for the lag
// behind the target, the motion over a stretch in which the target keeps its velocity is known in closed form, so that
// a step is exact for any length and any stiffness, and the result does not depend on how it is cut into steps.
#pragma once

#include "baker/core/types.h"

namespace ft::inline solvers {

struct DampedOscillator {
  double omega = 1;   ///< undamped angular frequency [rad/s], > 0
  double zeta = 0.3;  ///< damping ratio [1], >= 0; 1: critical

  /// Of a point behind its target.
  struct Lag {
    Vec3 position = Vec3::Zero();  ///< [m]
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
  };

  /// The target gets another velocity at once; the point keeps its own. change: new - old [m/s].
  static void turn(Lag& lag, const Vec3& change) { lag.velocity -= change; }
  /// dt later, the target going on as it does. dt >= 0 [s].
  void advance(Lag& lag, double dt) const;
};

}  // namespace ft::inline solvers

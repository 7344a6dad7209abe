// Two-bone inverse kinematics, closed form: the bend of the middle joint follows from the distance, the turn of the
// chain from the direction (law of cosines; e.g. Tolani, Goswami and Badler 2000). The plane of the bend
// stays the one that the pose has.
#pragma once

#include "baker/core/types.h"

namespace ft::inline io {

/// Bend of knee or elbow, 0 when straight [rad]. A pose that is outside by itself may stay so.
struct BendLimits {
  double least = 0.035;  ///< 0 to 0.2; above 0: a straight limb that has to bend would do so at infinite speed
  double most = 2.6;     ///< 1.5 to 3
};

struct TwoBonePose {
  Vec3 upper, lower, end;  ///< places of hip, knee, ankle
};

/// Distances from hip to ankle that the limits allow.
struct Reach {
  double least = 0, most = 0;
};
Reach reach_of(const TwoBonePose& pose, const BendLimits& limits);

/// Turns of the whole chain about the hip, and of what is below the knee about the knee, before it.
struct TwoBoneTurn {
  Quat upper = Quat::Identity(), lower = Quat::Identity();
};

/// The turns that take the end to the target; to the reachable point towards it, when it is out of reach. `axis`: about
/// which the limb usually bends, of length 1; what is bent further is bent about it.
TwoBoneTurn bend_to(const TwoBonePose& pose, const Vec3& target, const Vec3& axis, const BendLimits& limits);

}  // namespace ft::inline io

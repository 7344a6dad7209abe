// A primary that is cut to another place between two frames (a cut in the edit, a popped root). What follows it goes
// along rigidly over that interval, in position, velocity and history, and the body's own motion within the frame is
// solved for as in any other. Who finds them is io/import/repair/teleport_scan.h. Caution: gravity and wind do not turn
// with the character.
#pragma once

#include <span>

#include "baker/core/types.h"

namespace ft {

struct Teleport {
  int frame = 0;                                             ///< first frame at the new place
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< old place -> new place, world [m]
  Vec3 velocity_change = Vec3::Zero();  ///< of the body, beyond what turning with `motion` makes of its velocity [m/s]
};

/// The teleport into `frame`, null when there is none.
const Teleport* teleport_into(std::span<const Teleport> teleports, int frame);

/// Points to the new place.
void carry(const Teleport& teleport, std::span<Vec3> points);

}  // namespace ft

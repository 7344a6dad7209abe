// A child on a swing: the swing as a rigid pendulum that the child pumps, and the child who hops on to it, as the poses
// of a skeleton. For make_set.
//
//      pivot ---- y = drop + seat      seen from +x; the child faces z
//        |\                                                               .
//        | \  length L               theta'' = -g/L sin(theta) + pumping
//        |  \                                                             .
//        .   = board
#pragma once

#include <string>
#include <vector>

#include "baker/core/mesh.h"

namespace ft::sets {

struct SwingSettings {
  double length = 2.0;    ///< m, from the pivot to the board's upper side; playgrounds 1.8..2.4
  double seat = 0.42;     ///< m, height of the board's upper side at rest
  double start_deg = 18;  ///< how far back it is held at first
  double swing_deg = 36;  ///< to which the child pumps it up
  double seconds = 9;     ///< of motion
  double fps = 120;       ///< samples per second
  double child = 1.2;     ///< m, the child's height
};

/// Angle of the ropes at every sample [rad], forward positive; held until the child sits.
std::vector<double> swing_angles(const SwingSettings& settings);

/// Board and ropes at an angle; the same vertices for every angle.
Mesh make_swing(const SwingSettings& settings, double angle);

/// The beam that it hangs from, on four legs.
Mesh make_swing_frame(const SwingSettings& settings);

/// The child as the text of a BVH in metres: hops on to the board and swings.
std::string child_bvh(const SwingSettings& settings);

}  // namespace ft::sets

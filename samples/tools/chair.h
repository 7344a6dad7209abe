// A chair, a bevelled seat on four legs, the hind ones carrying two boards to lean against; and somebody who sits down
// on it, as the poses of a skeleton. For make_set.
#pragma once

#include <string>

#include "baker/core/mesh.h"

namespace ft::sets {

struct ChairSettings {
  double seat = 0.41;   ///< m, height of the seat's upper side; as high as the hollow of the knee, adults 0.38..0.47
  double width = 0.44;  ///< m
  double depth = 0.45;  ///< m
  double back = 0.92;   ///< m, height of the back
};

/// Stands on y = 0 and faces z, a hand's breadth behind the origin, where the sitter stands.
Mesh make_chair(const ChairSettings& settings);

struct SitterSettings {
  double height = 1.68;  ///< m
  double seconds = 4;    ///< of motion
  double fps = 60;       ///< samples per second
};

/// A BVH in metres: stands before the chair at the origin, facing z, sits down in a second and a half, and rests the
/// hands on the lap.
std::string sitter_bvh(const SitterSettings& settings, const ChairSettings& chair);

}  // namespace ft::sets

// Who runs through make_set's playground, as the poses of a skeleton.
#pragma once

#include <string>

namespace ft::sets {

struct RunnerSettings {
  double height = 1.7;    ///< m
  double speed = 2.9;     ///< m/s, an easy run
  double stride = 0.72;   ///< s, from a foot's touch-down to its next
  double support = 0.34;  ///< share of it in which that foot is on the ground; below 0.5 it is a run
  double start = 0;       ///< share of a stride at the first sample, after the left foot's touch-down
  double seconds = 6;     ///< of motion
  double fps = 120;       ///< samples per second
};

/// A BVH in metres: from the origin along z, on the ground y = 0. The ball of a foot that is on the ground stands
/// still.
std::string runner_bvh(const RunnerSettings& settings);

}  // namespace ft::sets

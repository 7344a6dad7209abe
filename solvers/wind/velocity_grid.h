// Velocities on a regular grid, as fluid solvers store them: linear between voxels and between frames, still outside.
#pragma once

#include <array>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline solvers {

/// One frame.
struct VelocityVoxels {
  std::array<int, 3> lowest{};    ///< index of the first voxel, as the file counts them
  std::array<int, 3> count{};     ///< along x, y, z; velocities has that many, x fastest
  Eigen::Affine3d to_world;       ///< from indices to metres, y up; the centre of voxel i is at i
  std::vector<Vec3f> velocities;  ///< m/s, world axes
};

/// Frames at equal distances in time. Before the first and after the last it is these.
class VelocityGrid {
 public:
  /// At least one frame; first_time of the first [s from the shot's first frame]; fps: frames a second.
  VelocityGrid(std::vector<VelocityVoxels> frames, double first_time, double fps);
  Vec3 velocity(const Vec3& place, double time) const;
  double fastest() const { return fastest_; }
  const std::vector<VelocityVoxels>& frames() const { return frames_; }

 private:
  std::vector<VelocityVoxels> frames_;
  double first_time_ = 0, fps_ = 24, fastest_ = 0;
};

}  // namespace ft::inline solvers

// Velocities on a regular grid, as fluid solvers store them: linear between voxels and between frames, still outside:
// what lies beyond the voxels counts as zero, so that the velocity fades over one voxel and has no edge.
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
  /// At least one frame, all numbers finite; a frame may have no voxels. first_time of the first [s from the shot's
  /// first frame]; fps: frames a second, > 0.
  VelocityGrid(std::vector<VelocityVoxels> frames, double first_time, double fps);
  /// m/s; of finite place and time. Any threads.
  Vec3 velocity(const Vec3& place, double time) const;
  /// The fastest voxel [m/s]: nothing in between is faster.
  double fastest() const { return fastest_; }
  const std::vector<VelocityVoxels>& frames() const { return frames_; }

 private:
  std::vector<VelocityVoxels> frames_;
  std::vector<Eigen::Affine3d> to_voxels_;  ///< of each frame: from metres to voxels from its lowest one
  double first_time_ = 0, fps_ = 24, fastest_ = 0;
};

}  // namespace ft::inline solvers

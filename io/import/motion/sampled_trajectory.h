// A geometry cache as a Trajectory: cubic between samples (Catmull-Rom with the samples' own times; Hermite ends are
// one-sided, and so are those at a jump, which else would swing the body out before and after it), held before the
// first and after the last. Its parts are the pieces of the mesh, and the largest is the parent of all; where both keep
// their shapes they are limbs with a joint between them, else eyes and nails on a skin. It has no bind pose of its own:
// garments are modelled on the first pose of the shot. Before the shot it is that pose, set back by the run-up
// (run_up.h); where a later part of the shot is baked, the pre-roll goes vertex by vertex from the one pose, placed by
// the rigid motion that brings it nearest, to the other. Samples that repeat go on from where the last cycle has got
// to, by the level motion that fits best (cycle.h).
#pragma once

#include "baker/core/trajectory.h"
#include "io/import/character/geometry_cache.h"
#include "io/import/motion/character_trajectory.h"
#include "io/import/motion/cycle.h"

namespace ft::inline io {

class SampledTrajectory : public Trajectory {
 public:
  /// sheet: SurfacePart::sheet of all its parts.
  SampledTrajectory(GeometryCache cache, const Mat3& axes, double unit_scale, const Playback& playback,
                    bool sheet = false);

  const Surface& surface() const override { return surface_; }
  void bind_pose(std::span<Vec3> positions) const override { at(playback_.bind.value_or(playback_.start), positions); }
  void sample(double time, std::span<Vec3> positions) const override;
  Eigen::Isometry3d bind_to_start() const override;
  double preroll() const override { return playback_.preroll; }

  /// Of samples that repeat; the period is 0 of those that do not.
  const Cycle& cycle() const { return cycle_; }

 private:
  void find_cycle();
  void find_jumps();
  bool jumps(std::size_t interval, std::size_t vertex) const;
  Vec3 tangent(std::size_t sample, std::size_t vertex) const;
  void at(double time, std::span<Vec3> positions) const;
  void at_own(double time, std::span<Vec3> positions) const;  ///< within the samples

  GeometryCache cache_;
  double size_ = 0;                ///< of the first sample [m]
  std::vector<char> any_jumps_;    ///< per interval between samples: whether a vertex does
  std::vector<Vec3> placed_bind_;  ///< where the pre-roll begins, if that is another pose than the first frame's
  Surface surface_;
  Mat3 linear_;
  Playback playback_;
  Cycle cycle_;
  Eigen::Isometry3d bind_to_start_ = Eigen::Isometry3d::Identity();  ///< without the run-up
  Vec3 start_velocity_ = Vec3::Zero();  ///< mean over the vertices at the first frame [m/s]
};

}  // namespace ft::inline io

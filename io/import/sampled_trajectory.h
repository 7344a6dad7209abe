// A geometry cache as a Trajectory: cubic between samples (Catmull-Rom with the samples' own times; Hermite ends are
// one-sided), held before the first and after the last; before the shot it is the first pose, set back by the run-up
// (run_up.h). Its parts are the pieces of the mesh, and the largest is the parent of all; where both keep their shapes
// they are limbs with a joint between them, else eyes and nails on a skin. It has no bind pose of its own: garments are
// modelled on its first sample of the shot.
#pragma once

#include "baker/core/trajectory.h"
#include "io/import/character_trajectory.h"
#include "io/import/geometry_cache.h"

namespace ft {

class SampledTrajectory : public Trajectory {
 public:
  SampledTrajectory(GeometryCache cache, const Mat3& axes, double unit_scale, const Playback& playback);

  const Surface& surface() const override { return surface_; }
  void bind_pose(std::span<Vec3> positions) const override { at(playback_.start, positions); }
  void sample(double time, std::span<Vec3> positions) const override;
  Eigen::Isometry3d bind_to_start() const override;
  double preroll() const override { return playback_.preroll; }

 private:
  void at(double time, std::span<Vec3> positions) const;

  GeometryCache cache_;
  Surface surface_;
  Mat3 linear_;
  Playback playback_;
  Vec3 start_velocity_ = Vec3::Zero();  ///< mean over the vertices at the first frame [m/s]
};

/// Pieces of a surface that are not joined by triangles: one index per vertex, numbered by first vertex; vertices
/// without triangles join piece 0.
std::vector<int> connected_pieces(int vertex_count, std::span<const Triangle> triangles, int& piece_count);

}  // namespace ft

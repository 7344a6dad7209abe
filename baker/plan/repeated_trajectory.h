// A clip that is played several times in a row, each time from where the last one has got to: a run of two steps
// becomes a run down the road.
#pragma once

#include <memory>

#include "baker/core/trajectory.h"

namespace ft::inline baker {

class RepeatedTrajectory final : public Trajectory {
 public:
  /// period: of the clip, from the shot's first frame to its end [s], > 0.
  RepeatedTrajectory(std::shared_ptr<const Trajectory> own, double period, int times);

  const Surface& surface() const override { return own_->surface(); }
  void bind_pose(std::span<Vec3> positions) const override { own_->bind_pose(positions); }
  void sample(double time, std::span<Vec3> positions) const override;
  Eigen::Isometry3d bind_to_start() const override { return own_->bind_to_start(); }
  double preroll() const override { return own_->preroll(); }

  /// From the first pose to the last, as a turn about the vertical and a level way, which fits best.
  const Eigen::Isometry3d& step() const { return step_; }
  /// What the last pose then differs from the first by, root mean square [m].
  double misfit() const { return misfit_; }

 private:
  std::shared_ptr<const Trajectory> own_;
  double period_ = 1;
  int times_ = 1;
  Eigen::Isometry3d step_ = Eigen::Isometry3d::Identity();
  double misfit_ = 0;
};

}  // namespace ft::inline baker

// A trajectory that is moved to another place in the world: two characters whose files both begin at the origin.
#pragma once

#include <memory>
#include <utility>

#include "baker/core/trajectory.h"

namespace ft::inline baker {

/// The bind pose stays as the file has it, for garments are modelled on that.
class PlacedTrajectory final : public Trajectory {
 public:
  PlacedTrajectory(std::shared_ptr<const Trajectory> own, const Eigen::Isometry3d& place)
      : own_(std::move(own)), place_(place) {}

  const Surface& surface() const override { return own_->surface(); }
  void bind_pose(std::span<Vec3> positions) const override { own_->bind_pose(positions); }
  void sample(double time, std::span<Vec3> positions) const override {
    own_->sample(time, positions);
    for (Vec3& p : positions) p = place_ * p;
  }
  Eigen::Isometry3d bind_to_start() const override { return place_ * own_->bind_to_start(); }
  double preroll() const override { return own_->preroll(); }

 private:
  std::shared_ptr<const Trajectory> own_;
  Eigen::Isometry3d place_;
};

}  // namespace ft::inline baker

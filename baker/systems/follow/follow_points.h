// Vertices that follow their animation together, as a belly does: their weighted middle is a point on a spring, and its
// lag displaces each by its weight.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "baker/core/teleport.h"
#include "baker/core/trajectory.h"
#include "baker/systems/follow/follow_bones.h"

namespace ft::inline baker {

class FollowedPoints final : public Trajectory {
 public:
  /// weights: 0..1 for each vertex, not all 0.
  FollowedPoints(std::shared_ptr<const Trajectory> own, std::vector<double> weights, const FollowSpec& spec,
                 const FollowTiming& timing, std::span<const Teleport> teleports);

  const Surface& surface() const override { return own_->surface(); }
  void bind_pose(std::span<Vec3> positions) const override { own_->bind_pose(positions); }
  void sample(double time, std::span<Vec3> positions) const override;
  Eigen::Isometry3d bind_to_start() const override { return own_->bind_to_start(); }
  double preroll() const override { return own_->preroll(); }

  /// How far a vertex of weight 1 is from its animated place [m].
  double lag(double time) const { return displacement(time).norm(); }

 private:
  Vec3 displacement(double time) const;

  std::shared_ptr<const Trajectory> own_;
  std::vector<double> weights_;
  double first_ = 0, dt_ = 1;    ///< of the table [s]
  std::vector<Vec3> displaced_;  ///< by what a vertex of weight 1 is displaced [m]
};

}  // namespace ft::inline baker

#include "baker/plan/repeated_trajectory.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/level_fit.h"

namespace ft::inline baker {

RepeatedTrajectory::RepeatedTrajectory(std::shared_ptr<const Trajectory> own, double period, int times)
    : own_(std::move(own)), period_(period), times_(times) {
  CHECK(period > 0 && times >= 1);
  std::vector<Vec3> first(static_cast<std::size_t>(own_->surface().vertex_count())), last(first.size());
  own_->sample(0, first);
  own_->sample(period, last);
  step_ = level_fit(first, last);
  for (std::size_t i = 0; i < first.size(); ++i) misfit_ += (step_ * first[i] - last[i]).squaredNorm();
  misfit_ = std::sqrt(misfit_ / static_cast<double>(first.size()));
}

void RepeatedTrajectory::sample(double time, std::span<Vec3> positions) const {
  const int before = time < period_ ? 0 : std::min(times_ - 1, static_cast<int>(std::floor(time / period_)));
  own_->sample(time - before * period_, positions);
  if (before == 0) return;
  Eigen::Isometry3d all = Eigen::Isometry3d::Identity();
  for (int i = 0; i < before; ++i) all = step_ * all;
  for (Vec3& p : positions) p = all * p;
}

}  // namespace ft::inline baker

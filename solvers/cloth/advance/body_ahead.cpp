#include "solvers/cloth/advance/body_ahead.h"

#include <algorithm>

#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr int k_at_once =
    8;  ///< most poses that are worked out together; more would keep more cores busy and more memory

}  // namespace

void BodyAhead::fill(double time, BodyPose& pose) const {
  collider_->drawn(time, pose.drawn);
  collider_->feasible(time, pose.drawn, pose.feasible, &pose.absent);
}

void BodyAhead::begin(double t0, double t1) {
  if (!collider_) return;
  const bool goes_on = t1_ == t0;
  if (goes_on) std::swap(start_, end_);
  t0_ = t0;
  t1_ = t1;
  cut_ = false;
  count_ = 0;
  ahead_.resize(k_at_once);
  if (!goes_on) fill(t0, start_);
  fill(t1, end_);
}

void BodyAhead::cut(const Teleport& teleport) {
  carry(teleport, std::span(start_.drawn));
  carry(teleport, std::span(start_.feasible));
  cut_ = true;
  count_ = 0;
}

const BodyPose& BodyAhead::after(int k, int substeps) {
  if (!collider_ || k + 1 == substeps) return end_;
  if (substeps != substeps_ || k < first_ || k >= first_ + count_)
    evaluate(k, std::min(substeps - 1 - k, k_at_once), substeps);
  return ahead_[at(k - first_)];
}

void BodyAhead::evaluate(int first, int count, int substeps) {
  first_ = first;
  count_ = count;
  substeps_ = substeps;
  const double h = (t1_ - t0_) / substeps;
  parallel_tasks(at(count), [&](std::size_t i) {
    BodyPose& pose = ahead_[i];
    const double number = static_cast<double>(at(first) + i + 1);
    if (!cut_) return fill(t0_ + number * h, pose);
    pose.drawn = start_.drawn;
    for (std::size_t v = 0; v < pose.drawn.size(); ++v)
      pose.drawn[v] += number / substeps * (end_.drawn[v] - start_.drawn[v]);
    collider_->feasible(t0_ + number * h, pose.drawn, pose.feasible, &pose.absent);
  });
}

}  // namespace ft::inline solvers

#include "solvers/cloth/body_ahead.h"

#include <algorithm>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

/// Most poses that are worked out together, an even number; more would keep more cores busy and more memory.
constexpr int k_at_once = 8;
/// With fewer substeps each of them is made feasible.
constexpr int k_many = 4;
constexpr std::size_t k_block = 4096;

}  // namespace

double BodyAhead::time_after(int count) const {
  return t0_ + count * ((t1_ - t0_) / substeps_);
}

/// Whether the pose is worked out when `count` substeps have ended, and not between its neighbours.
bool BodyAhead::is_feasible(int count) const {
  return count % 2 == 0 || substeps_ < k_many || count == substeps_;
}

void BodyAhead::make_feasible(double time, BodyPose& pose) const {
  collider_->feasible(time, pose.drawn, pose.feasible);
  collider_->refine(pose.drawn, pose.given_way);
  for (std::size_t v = 0; v < pose.feasible.size(); ++v) pose.given_way[v] = pose.feasible[v] - pose.given_way[v];
}

void BodyAhead::fill(double time, BodyPose& pose) const {
  collider_->drawn(time, pose.drawn);
  make_feasible(time, pose);
}

/// The drawn surface when `count` substeps have ended, and the feasible one where it is worked out.
void BodyAhead::draw(int count, BodyPose& pose) const {
  if (cut_) {
    pose.drawn = start_.drawn;
    for (std::size_t v = 0; v < pose.drawn.size(); ++v)
      pose.drawn[v] += static_cast<double>(count) / substeps_ * (end_.drawn[v] - start_.drawn[v]);
  } else {
    collider_->drawn(time_after(count), pose.drawn);
  }
  if (is_feasible(count))
    make_feasible(time_after(count), pose);
  else
    collider_->refine(pose.drawn, pose.feasible);
}

/// What draw() has left open, between neighbours that have given way.
void BodyAhead::fill_between() {
  for (int i = 0; i < count_; ++i) {
    const int ended = first_ + i + 1;
    if (is_feasible(ended)) continue;
    const std::vector<Vec3>& a = i == 0 ? before_ : ahead_[at(i - 1)].given_way;
    const std::vector<Vec3>& b = ended + 1 == substeps_ ? end_.given_way : ahead_[at(i + 1)].given_way;
    std::vector<Vec3>& x = ahead_[at(i)].feasible;
    parallel_for(x.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) x[v] += 0.5 * (a[v] + b[v]);
    });
  }
}

void BodyAhead::begin(double t0, double t1, int expected_substeps) {
  if (!collider_) return;
  const bool goes_on = t1_ == t0;
  if (goes_on) std::swap(start_, end_);
  t0_ = t0;
  t1_ = t1;
  cut_ = false;
  first_ = 0;
  substeps_ = expected_substeps;
  count_ = std::min(substeps_ - 1, k_at_once);
  ahead_.resize(k_at_once);
  parallel_tasks(at(count_) + 2, [&](std::size_t i) {
    if (i == 0) {
      fill(t1, end_);
    } else if (i == 1) {
      if (!goes_on) fill(t0, start_);
    } else {
      draw(static_cast<int>(i) - 1, ahead_[i - 2]);
    }
  });
  before_ = start_.given_way;
  fill_between();
}

void BodyAhead::cut(const Teleport& teleport) {
  carry(teleport, std::span(start_.drawn));
  carry(teleport, std::span(start_.feasible));
  std::vector<Vec3> refined;
  collider_->refine(start_.drawn, refined);
  for (std::size_t v = 0; v < refined.size(); ++v) start_.given_way[v] = start_.feasible[v] - refined[v];
  cut_ = true;
  count_ = 0;
}

const BodyPose& BodyAhead::after(int k, int substeps) {
  if (!collider_ || k + 1 == substeps) return end_;
  if (substeps != substeps_ || k < first_ || k >= first_ + count_) {
    CHECK(k % k_at_once == 0);
    before_ = k == 0 ? start_.given_way : ahead_.back().given_way;
    substeps_ = substeps;
    evaluate(k);
  }
  return ahead_[at(k - first_)];
}

/// The poses after substeps `first` and on; before_ is what stood then.
void BodyAhead::evaluate(int first) {
  first_ = first;
  count_ = std::min(substeps_ - 1 - first, k_at_once);
  parallel_tasks(at(count_), [&](std::size_t i) { draw(first + static_cast<int>(i) + 1, ahead_[i]); });
  fill_between();
}

}  // namespace ft

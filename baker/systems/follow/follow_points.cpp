#include "baker/systems/follow/follow_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/follow/damped_oscillator.h"

namespace ft::inline baker {
namespace {

constexpr double k_step = 1.0 / 240;  ///< longest over which the middle is taken to keep its velocity [s]

}  // namespace

FollowedPoints::FollowedPoints(std::shared_ptr<const Trajectory> own, std::vector<double> weights,
                               const FollowSpec& spec, const FollowTiming& timing, std::span<const Teleport> teleports)
    : own_(std::move(own)), weights_(std::move(weights)) {
  const int steps = timing.steps(k_step), lead = timing.preroll_frames;
  dt_ = 1 / (timing.fps * steps);
  first_ = -lead / timing.fps;
  DampedOscillator spring{2 * std::numbers::pi * spec.frequency, spec.damping_ratio};
  double sum = 0;
  for (const double w : weights_) sum += w;
  std::vector<Vec3> x(weights_.size());
  const auto middle_at = [&](double time) {
    own_->sample(time, x);
    Vec3 out = Vec3::Zero();
    for (std::size_t v = 0; v < x.size(); ++v) out += weights_[v] / sum * x[v];
    return out;
  };
  DampedOscillator::Lag lag;
  Vec3 before = middle_at(first_), velocity = Vec3::Zero();
  displaced_.push_back(Vec3::Zero());
  bool started = false;
  for (int frame = 1 - lead; frame < timing.frame_count; ++frame) {
    const Teleport* jump = teleport_into(teleports, timing.first_frame + frame);
    if (jump) {
      const Mat3 turn = jump->motion.rotation();
      lag = {turn * lag.position, turn * lag.velocity};
      velocity = turn * velocity;
    }
    for (int k = 1; k <= steps; ++k) {
      const Vec3 now = middle_at((frame - 1) / timing.fps + k * dt_);
      if (!jump) {
        const Vec3 faster = (now - before) / dt_;
        if (started) DampedOscillator::turn(lag, faster - velocity);
        velocity = faster;
        started = true;
        spring.advance(lag, dt_);
      }
      before = now;
      Vec3 taken = spec.amount * lag.position;
      if (taken.norm() > spec.max_distance) taken *= spec.max_distance / taken.norm();
      displaced_.push_back(taken);
    }
  }
}

Vec3 FollowedPoints::displacement(double time) const {
  const double place = std::clamp((time - first_) / dt_, 0.0, static_cast<double>(displaced_.size() - 1));
  const auto i = static_cast<std::size_t>(place);
  const std::size_t next = std::min(i + 1, displaced_.size() - 1);
  return displaced_[i] + (place - static_cast<double>(i)) * (displaced_[next] - displaced_[i]);
}

void FollowedPoints::sample(double time, std::span<Vec3> positions) const {
  own_->sample(time, positions);
  const Vec3 by = displacement(time);
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += weights_[v] * by;
}

}  // namespace ft::inline baker

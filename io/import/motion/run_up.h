// The run-up: in the last part of the pre-roll a character that enters the shot at speed picks that speed up, so that
// its garments do not meet the first frame standing still. The body moves as a whole, along a straight line; its pose
// is the first frame's.
#pragma once

#include <algorithm>

#include "baker/core/smooth_step.h"
#include "baker/core/types.h"

namespace ft::inline io {

/// Share of the pre-roll that is spent blending from the bind pose; the rest is the run-up, where garments settle in
/// the first pose.
constexpr double k_blend_share = 0.6;

/// How much of the first frame's pose there is at a time of the pre-roll, the rest being the bind pose: 0 at its start;
/// time < 0, preroll > 0, in s.
inline double blend_weight(double time, double preroll) {
  return smooth_step((time + preroll) / (k_blend_share * preroll));
}

/// Over which the speed at the first frame is measured [s].
constexpr double k_speed_interval = 1.0 / 60;
/// A body that is faster than this between two frames [m/s] has jumped, and no run-up is made of it.
constexpr double k_fastest_run_up = 20;

/// Where the body is before the shot, relative to its first frame [m]. velocity: at the first frame [m/s]; time <= 0
/// and preroll in s. The speed rises as a smooth step from rest to `velocity`.
inline Vec3 run_up_offset(const Vec3& velocity, double time, double preroll) {
  const double length = (1 - k_blend_share) * preroll;
  if (time >= 0 || length <= 0 || velocity.norm() > k_fastest_run_up) return Vec3::Zero();
  const double u = std::clamp(1 + time / length, 0.0, 1.0);
  return -length * (0.5 - u * u * u + 0.5 * u * u * u * u) * velocity;
}

}  // namespace ft::inline io

// A point on a spring behind a target, against the closed forms of the damped oscillator and against itself cut into
// other steps.
#include "solvers/follow/damped_oscillator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ft {
namespace {

using Lag = DampedOscillator::Lag;

Lag after(const DampedOscillator& spring, Lag lag, double time, int steps) {
  for (int k = 0; k < steps; ++k) spring.advance(lag, time / steps);
  return lag;
}

TEST(DampedOscillator, Undamped_it_swings_as_a_cosine) {
  const DampedOscillator spring{5, 0};
  const Lag out = after(spring, {Vec3(1, 0, 0), Vec3(0, 10, 0)}, 0.7, 1);
  EXPECT_NEAR(out.position.x(), std::cos(3.5), 1e-14);
  EXPECT_NEAR(out.position.y(), 2 * std::sin(3.5), 1e-14);
  EXPECT_NEAR(out.velocity.x(), -5 * std::sin(3.5), 1e-13);
}

TEST(DampedOscillator, Critically_damped_it_comes_back_without_overshoot) {
  const DampedOscillator spring{4, 1};
  const Lag out = after(spring, {Vec3(1, 0, 0), Vec3::Zero()}, 0.5, 1);
  EXPECT_NEAR(out.position.x(), (1 + 4 * 0.5) * std::exp(-4 * 0.5), 1e-14);
}

TEST(DampedOscillator, A_target_that_sets_off_is_followed_by_the_closed_form) {
  const double w = 8, z = 0.25, a = w * std::sqrt(1 - z * z), speed = 1.5, t = 0.4;
  const DampedOscillator spring{w, z};
  Lag lag;
  DampedOscillator::turn(lag, Vec3(speed, 0, 0));
  spring.advance(lag, t);
  EXPECT_NEAR(lag.position.x(), -speed * std::exp(-z * w * t) * std::sin(a * t) / a, 1e-14);
}

TEST(DampedOscillator, A_step_is_exact_however_it_is_cut) {
  for (const double zeta : {0.0, 0.3, 0.999999, 1.0, 1.000001, 3.0, 10.0})
    for (const double omega : {0.3, 20.0, 400.0}) {
      const DampedOscillator spring{omega, zeta};
      const Lag start{Vec3(0.2, -1, 3), Vec3(-4, 0.5, 7)};
      const Lag once = after(spring, start, 0.25, 1), often = after(spring, start, 0.25, 1000);
      EXPECT_LT((once.position - often.position).norm(), 1e-10) << zeta << " " << omega;
      EXPECT_LT((once.velocity - often.velocity).norm(), 1e-10 * (1 + omega)) << zeta << " " << omega;
    }
}

TEST(DampedOscillator, It_stays_finite_for_any_stiffness_and_step) {
  for (const double zeta : {0.0, 1.0, 10.0}) {
    const DampedOscillator spring{1e6, zeta};
    const Lag out = after(spring, {Vec3::Ones(), Vec3::Ones()}, 1e3, 1);
    EXPECT_TRUE(out.position.allFinite() && out.velocity.allFinite()) << zeta;
    EXPECT_LT(out.position.norm(), 2) << zeta;
  }
}

}  // namespace
}  // namespace ft

// A pin pulls no harder than its limit, and what it has lost comes back without a swing.
#include "solvers/cloth/model/pin_pull.h"

#include <gtest/gtest.h>

namespace ft {
namespace {

constexpr double k_step = 0.01;

PinPoint pin_point() {
  PinPoint pin;
  pin.stiffness = 200;
  pin.max_pull = 0.5;  // 2.5 mm
  return pin;
}

PinPull pull_of(const Vec3& x, const Vec3& v, const Vec3& target_motion = Vec3::Zero()) {
  return {pin_point(), x, v, target_motion, target_motion, k_step, 0};  // the target starts at the origin
}

TEST(PinPull, Its_gradient_is_that_of_its_energy) {
  for (const double away : {0.001, 0.3}) {
    const Vec3 start(away, 0.1 * away, 0), speed(-3, 1, 0.5);
    const PinPull pull = pull_of(start, speed);
    const Vec3 x = start + 0.7 * k_step * speed, gradient = pull.gradient(x);
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = 1e-6 * Vec3::Unit(k);
      EXPECT_NEAR(gradient[k], (pull.energy(x + d) - pull.energy(x - d)) / 2e-6, 1e-6);
    }
  }
}

TEST(PinPull, What_has_slipped_off_comes_back_at_its_speed_and_no_faster) {
  const Vec3 start(0.3, 0, 0);
  for (const double speed : {0.5, PinPull::k_return_speed, 8.0}) {
    const Vec3 v(-speed, 0, 0);
    const double force = -pull_of(start, v).gradient(start + k_step * v).x();  // positive: away from the pin
    EXPECT_NEAR(force, 0.5 * (speed / PinPull::k_return_speed - 1), 1e-12);
  }
}

TEST(PinPull, What_is_drawn_away_what_holds_and_what_goes_with_the_pin_feels_the_spring_alone) {
  const auto expect_spring = [](const PinPull& pull, const Vec3& x, const Vec3& target) {
    const double stretch = (x - target).norm();
    EXPECT_NEAR(pull.gradient(x).norm(), std::min(200 * stretch, 0.5), 1e-12);
    EXPECT_NEAR(pull.stiffness(x), std::min(200.0, 0.5 / stretch), 1e-9);
  };
  const Vec3 far(0.3, 0, 0), near(0.002, 0, 0), v(4, 0, 0);
  expect_spring(pull_of(far, v), far + k_step * v, Vec3::Zero());
  expect_spring(pull_of(near, -v), near, Vec3::Zero());
  const Vec3 along = -k_step * v;
  expect_spring(pull_of(far, -v, along), far + along, along);
}

TEST(PinPull, Does_nothing_while_it_does_not_hold) {
  PinPoint pin = pin_point();
  pin.hold.until = -1;
  EXPECT_FALSE(PinPull(pin, Vec3(0.3, 0, 0), Vec3(-4, 0, 0), Vec3::Zero(), Vec3::Zero(), k_step, 0).holds());
  EXPECT_TRUE(pull_of(Vec3(0.3, 0, 0), Vec3(-4, 0, 0)).holds());
}

}  // namespace
}  // namespace ft

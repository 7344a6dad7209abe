// Curves against closed forms: each interpolation, each rule beyond the keys, tangents that bend time.
#include "io/import/character/curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/random.h"

namespace ft {
namespace {

using enum CurveInterpolation;

Curve saw(CurveInfinity rule, int count = -1) {
  Curve out{.times = {1, 2, 3}, .values = {0, 4, 1}, .interpolation = {}, .handles = {}, .before = {}, .after = {}};
  out.before = out.after = {rule, count};
  return out;
}

TEST(Curve, Holds_joins_and_jumps) {
  Curve curve{.times = {0, 1, 2, 3},
              .values = {2, 5, 3, 9},
              .interpolation = {k_constant, k_constant_next, k_linear, k_linear},
              .handles = {},
              .before = {},
              .after = {}};
  EXPECT_EQ(curve.at(-1), 2);
  EXPECT_EQ(curve.at(0), 2);
  EXPECT_EQ(curve.at(0.999), 2);
  EXPECT_EQ(curve.at(1), 5);
  EXPECT_EQ(curve.at(1.001), 3);
  EXPECT_EQ(curve.at(2), 3);
  EXPECT_DOUBLE_EQ(curve.at(2.25), 4.5);
  EXPECT_EQ(curve.at(4), 9);
  EXPECT_EQ(Curve{}.at(1), 0);
}

TEST(Curve, Of_equal_times_the_last_key_holds) {
  Curve curve;
  curve.times = {0, 1, 1, 2}, curve.values = {0, 1, 5, 6};
  EXPECT_DOUBLE_EQ(curve.at(0.5), 0.5);
  EXPECT_EQ(curve.at(1), 5);
  EXPECT_DOUBLE_EQ(curve.at(1.5), 5.5);
}

TEST(Curve, Even_handles_reproduce_a_cubic) {
  const auto f = [](double t) { return 0.4 - 3 * t + 0.7 * t * t + 0.31 * t * t * t; };
  const auto slope = [](double t) { return -3 + 1.4 * t + 0.93 * t * t; };
  Curve curve;
  curve.times = {0, 0.4, 1.7};
  curve.interpolation.assign(3, k_cubic);
  for (std::size_t i = 0; i < 3; ++i) {
    const double before = i > 0 ? (curve.times[i] - curve.times[i - 1]) / 3 : 0;
    const double after = i < 2 ? (curve.times[i + 1] - curve.times[i]) / 3 : 0;
    curve.values.push_back(f(curve.times[i]));
    curve.handles.push_back({before, before * slope(curve.times[i]), after, after * slope(curve.times[i])});
  }
  for (double t = 0; t <= 1.7; t += 0.01) EXPECT_NEAR(curve.at(t), f(t), 1e-13);
}

TEST(Curve, Handles_of_any_length_give_the_point_of_the_bezier_curve_at_a_time) {
  std::uint64_t draw = 0;
  const auto uniform = [&] { return random_uniform({7, 0, 0, 0}, draw++); };
  for (int round = 0; round < 200; ++round) {
    const double w1 = uniform(), w2 = uniform(), a = uniform(), b = uniform();
    Curve curve;
    curve.times = {2, 4}, curve.values = {1, -1};
    curve.interpolation.assign(2, k_cubic);
    curve.handles = {{0, 0, 2 * w1, 5 * a}, {2 * w2, -3 * b, 0, 0}};
    for (double s = 0; s <= 1; s += 0.05) {
      const double r = 1 - s;
      const double x = 3 * r * r * s * w1 + 3 * r * s * s * (1 - w2) + s * s * s;
      const double y = r * r * r + 3 * r * r * s * (1 + 5 * a) + 3 * r * s * s * (-1 + 3 * b) - s * s * s;
      // Where time nearly stands still a value cannot be told from its neighbours.
      const double speed = 3 * r * r * w1 + 6 * r * s * (1 - w2 - w1) + 3 * s * s * w2;
      if (speed > 1e-3) {
        EXPECT_NEAR(curve.at(2 + 2 * x), y, 1e-11 / speed);
      }
    }
  }
}

TEST(Curve, Time_that_stands_still_is_solved) {
  for (const auto& [x1, x2] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}, {1.0, 1.0}})
    for (double x = 0; x <= 1; x += 1.0 / 64) {
      const double t = bezier_parameter(x1, x2, x), r = 1 - t;
      EXPECT_NEAR(3 * r * r * t * x1 + 3 * r * t * t * x2 + t * t * t, x, 1e-14);
    }
}

TEST(Curve, Goes_on_before_and_after_its_keys) {
  const Curve repeat = saw(CurveInfinity::k_repeat);
  EXPECT_DOUBLE_EQ(repeat.at(3.5), 2);
  EXPECT_DOUBLE_EQ(repeat.at(7.5), 2);
  EXPECT_DOUBLE_EQ(repeat.at(0.5), 2.5);
  const Curve mirror = saw(CurveInfinity::k_mirror);
  EXPECT_DOUBLE_EQ(mirror.at(3.5), 2.5);
  EXPECT_DOUBLE_EQ(mirror.at(5.5), 2);
  EXPECT_DOUBLE_EQ(mirror.at(0.5), 2);
  EXPECT_DOUBLE_EQ(mirror.at(-1.5), 2.5);
  const Curve relative = saw(CurveInfinity::k_repeat_relative);
  EXPECT_DOUBLE_EQ(relative.at(3.5), 3);
  EXPECT_DOUBLE_EQ(relative.at(5.5), 4);
  EXPECT_DOUBLE_EQ(relative.at(0.5), 1.5);
  const Curve slope = saw(CurveInfinity::k_slope);
  EXPECT_DOUBLE_EQ(slope.at(0), -4);
  EXPECT_DOUBLE_EQ(slope.at(5), -5);
}

TEST(Curve, Ends_after_the_repetitions_that_it_is_given) {
  const Curve twice = saw(CurveInfinity::k_repeat, 2);
  EXPECT_DOUBLE_EQ(twice.at(6.5), 2.5);
  EXPECT_DOUBLE_EQ(twice.at(7.5), 1);
  EXPECT_DOUBLE_EQ(twice.at(-4), 0);
  const Curve mirrored = saw(CurveInfinity::k_mirror, 1);
  EXPECT_DOUBLE_EQ(mirrored.at(9), 0);
  const Curve relative = saw(CurveInfinity::k_repeat_relative, 2);
  EXPECT_DOUBLE_EQ(relative.at(100), 3);
  EXPECT_DOUBLE_EQ(saw(CurveInfinity::k_repeat, 0).at(3.5), 1);
}

}  // namespace
}  // namespace ft

// The multistep formulas on y' = i w y: order, loss of amplitude, stability with changing steps.
#include "solvers/base/integrator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <utility>

namespace ft {
namespace {

using Number = std::complex<double>;

/// y_0, y_-1, y_-2 and the steps between them, on their way.
struct Oscillation {
  Number now = 1, before, older;
  double h_previous, h_older;

  Oscillation(double w, double h) : h_previous(h), h_older(h) {
    before = std::exp(Number(0, -w * h));
    older = before * before;
  }
  void step(double w, double h, const IntegratorWeights& k) {
    const Number next = (k.a * now - k.b * before + k.c * older) / (1.0 - Number(0, k.beta * w * h));
    older = before, before = now, now = next;
    h_older = h_previous, h_previous = h;
  }
};

/// Amplitude lost in each radian, once the parasitic solutions are gone.
double loss(double wh, bool blended) {
  Oscillation y(wh, 1);
  const auto steps = [&](int count) {
    for (int i = 0; i < count; ++i)
      y.step(wh, 1, blended ? blended_weights(1, y.h_previous, y.h_older) : bdf2_weights(1, y.h_previous));
    return std::abs(y.now);
  };
  const double start = steps(50);
  return std::log(start / steps(100)) / (100 * wh);
}

TEST(Integrator, is_exact_for_constant_acceleration_whatever_the_steps) {
  const auto x = [](double t) { return 1 + 2 * t + 3 * t * t; };
  for (const double h : {0.05, 0.1, 0.13}) {
    const double p = 0.1, o = 0.08;
    const IntegratorWeights k = blended_weights(h, p, o);
    EXPECT_GT(k.c, 0) << h;
    EXPECT_NEAR(k.a * x(0) - k.b * x(-p) + k.c * x(-p - o) + k.beta * h * (2 + 6 * h), x(h), 1e-14) << h;
  }
}

TEST(Integrator, of_constant_steps_is_three_quarters_BDF2_and_a_quarter_BDF3) {
  // Slopes times h: BDF2 3/2, -2, 1/2; BDF3 11/6, -3, 3/2, -1/3.
  const double newest = 0.75 * 3 / 2 + 0.25 * 11 / 6;
  const IntegratorWeights k = blended_weights(0.1, 0.1, 0.1);
  EXPECT_NEAR(k.beta, 1 / newest, 1e-15);
  EXPECT_NEAR(k.a, (0.75 * 2 + 0.25 * 3) / newest, 1e-15);
  EXPECT_NEAR(k.b, (0.75 / 2 + 0.25 * 3 / 2) / newest, 1e-15);
  EXPECT_NEAR(k.c, 0.25 / 3 / newest, 1e-15);
}

TEST(Integrator, loses_half_of_what_BDF2_loses_in_slow_oscillations_and_most_of_it_in_fast_ones) {
  EXPECT_NEAR(loss(0.1, false), 0.1 * 0.1 * 0.1 / 4, 0.05 * 0.1 * 0.1 * 0.1);
  EXPECT_NEAR(loss(0.1, true) / loss(0.1, false), 0.5, 0.02);
  EXPECT_NEAR(loss(0.3, true) / loss(0.3, false), 0.5, 0.05);
  EXPECT_GT(loss(2, true) / loss(2, false), 0.6);
}

TEST(Integrator, does_not_run_away_whatever_the_frequency_and_the_steps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> ratio(0.3, 3);
  for (const double w : {0.0, 0.1, 1.0, 3.0, 10.0, 1e3, 1e6}) {
    for (int run = 0; run < 50; ++run) {
      Oscillation y(w, 1);
      double h = 1, most = 0;
      for (int i = 0; i < 400; ++i) {
        if (random() % 3 == 0) h = std::clamp(h * ratio(random), 0.01, 1.0);
        y.step(w, h, blended_weights(h, y.h_previous, y.h_older));
        most = std::max(most, std::abs(y.now));
      }
      EXPECT_LT(most, 1.02) << w;  // the start, where the history is exact and the formula is not
      EXPECT_LT(std::abs(y.now), 1 + 1e-9) << w;
    }
  }
}

TEST(Integrator, takes_fewer_points_where_it_knows_no_more_or_steps_grow_too_fast) {
  EXPECT_EQ(blended_weights(0.1, 0, 0).beta, 1);
  EXPECT_EQ(blended_weights(0.1, 0.04, 0.04).beta, 1);
  for (const auto& [p, o] : {std::pair{0.1, 0.0}, {0.06, 0.06}, {0.1, 0.05}}) {
    const IntegratorWeights k = blended_weights(0.1, p, o), bdf2 = bdf2_weights(0.1, p);
    EXPECT_EQ(k.c, 0);
    EXPECT_EQ(k.a, bdf2.a);
    EXPECT_EQ(k.beta, bdf2.beta);
  }
}

}  // namespace
}  // namespace ft

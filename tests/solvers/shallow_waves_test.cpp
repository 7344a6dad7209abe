// Shallow water without bodies, against exact solutions.
#include <numbers>

#include "baker/core/parallel.h"
#include "tests/solvers/shallow_scenes.h"

namespace ft {
namespace {

using namespace test;
constexpr double k_pi = std::numbers::pi;

/// When a signal, given at equal times, first crosses zero downwards and upwards after that, by straight lines [s].
std::vector<double> crossings(const std::vector<double>& signal, double dt) {
  std::vector<double> out;
  for (std::size_t n = 1; n < signal.size(); ++n)
    if ((signal[n - 1] > 0) != (signal[n] > 0))
      out.push_back(dt * (static_cast<double>(n) - 1 + signal[n - 1] / (signal[n - 1] - signal[n])));
  return out;
}

TEST(ShallowWaves, A_long_wave_goes_at_the_root_of_g_times_depth) {
  // A standing wave of one length over 64 cells: its period is length / speed.
  ShallowSetup s = still_water(64, 1, 1.0 / 64, 0.5);
  set_depth(s, [](double x, double) { return 0.5 + 1e-5 * std::cos(2 * k_pi * x); });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  std::vector<double> signal;
  const double dt = 1.0 / 200;
  for (int n = 0; n < 400; ++n) {
    signal.push_back(solver.depths(state)[0] - 0.5);
    solver.advance_frame(state, dt);
  }
  const auto zero = crossings(signal, dt);
  ASSERT_GE(zero.size(), 5u);
  const double period = (zero[4] - zero[0]) / 2;
  EXPECT_NEAR(1 / period, 2.2147, 0.005 * 2.2147);
}

TEST(ShallowWaves, A_basin_swings_with_the_period_of_its_first_mode) {
  ShallowSetup s = still_water(64, 1, 2.0 / 64, 0.5);
  set_depth(s, [](double x, double) { return 0.5 + 1e-6 * std::cos(k_pi * x / 2); });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  std::vector<double> signal;
  const double dt = 1.0 / 100;
  for (int n = 0; n < 800; ++n) {
    signal.push_back(solver.depths(state)[0] - 0.5);
    solver.advance_frame(state, dt);
  }
  const auto zero = crossings(signal, dt);
  ASSERT_GE(zero.size(), 7u);
  EXPECT_NEAR((zero[6] - zero[0]) / 3, 1.80609, 0.001 * 1.80609);
}

TEST(ShallowWaves, A_ring_goes_as_fast_along_the_axes_as_along_the_diagonals) {
  const int n = 201;
  ShallowSetup s = still_water(n, n, 0.05, 0.5);
  const double middle = 0.5 * n * s.cell;
  set_depth(s, [&](double x, double z) {
    const double r2 = (x - middle) * (x - middle) + (z - middle) * (z - middle);
    return 0.5 + 1e-4 * std::exp(-r2 / (2 * 0.3 * 0.3));
  });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  for (int f = 0; f < 36; ++f) solver.advance_frame(state, 1.0 / 24);
  const auto depth = solver.depths(state);
  // Where the crest is along a line through the middle, by a parabola through the highest three.
  const auto crest = [&](int di, int dk) {
    const double step = s.cell * std::sqrt(di * di + dk * dk);
    const auto level = [&](int m) { return depth[at(n / 2 + m * di) + at(n) * at(n / 2 + m * dk)]; };
    int best = 10;
    for (int m = 10; m * std::max(di, dk) < n / 2 - 2; ++m)
      if (level(m) > level(best)) best = m;
    const double a = level(best - 1), b = level(best), c = level(best + 1);
    return step * (best + 0.5 * (a - c) / (a - 2 * b + c));
  };
  const double axis = crest(1, 0), diagonal = crest(1, 1);
  EXPECT_GT(axis, 2);
  EXPECT_NEAR(axis / diagonal, 1, 0.01);
  EXPECT_NEAR(crest(0, 1) / axis, 1, 1e-9);
}

/// Mean error of a dam that breaks, by the length 3 c t of the wave and its height; depths beside the dam.
struct Dam {
  double error = 0, left = 0, right = 0, speed = 0;
};
Dam dam(int cells, double high, double low, double time, const std::function<double(double x, double t)>& exact) {
  ShallowSetup s = still_water(cells, 1, 10.0 / cells, 0);
  s.origin.x() = -5;
  set_depth(s, [&](double x, double) { return x < 0 ? high : low; });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  for (int f = 0; f < 24; ++f) solver.advance_frame(state, time / 24);
  const auto depth = solver.depths(state);
  Dam out;
  for (int i = 0; i < cells; ++i) out.error += std::abs(depth[at(i)] - exact(-5 + (i + 0.5) * s.cell, time)) * s.cell;
  out.error /= high * 3 * std::sqrt(k_g * high) * time;
  out.left = depth[at(cells / 2 - 1)], out.right = depth[at(cells / 2)];
  const auto v = solver.velocities(state);
  out.speed = 0.5 * (v[at(cells / 2 - 1)].x() + v[at(cells / 2)].x());
  return out;
}

double ritter(double x, double t) {
  const double c = std::sqrt(k_g);
  if (x < -c * t) return 1;
  if (x > 2 * c * t) return 0;
  return (2 * c - x / t) * (2 * c - x / t) / (9 * k_g);
}

TEST(ShallowWaves, A_dam_before_dry_ground_breaks_as_Ritter_says) {
  const Dam coarse = dam(200, 1, 0, 0.6, ritter), fine = dam(400, 1, 0, 0.6, ritter),
            finest = dam(800, 1, 0, 0.6, ritter);
  RecordProperty("L1_percent", std::to_string(100 * fine.error));
  EXPECT_LT(fine.error, 0.002);
  EXPECT_LT(fine.error, 0.7 * coarse.error);
  EXPECT_LT(finest.error, 0.7 * fine.error);
  EXPECT_NEAR(0.5 * (fine.left + fine.right), 4.0 / 9, 0.01 * 4 / 9);
  EXPECT_NEAR(fine.speed, 2.088, 0.01 * 2.088);
}

TEST(ShallowWaves, A_dam_before_shallow_water_breaks_as_Stoker_says) {
  // The depth between the wave and the shock, by halving.
  const double cl = std::sqrt(k_g), low = 0.1;
  double a = low, b = 1;
  for (int n = 0; n < 100; ++n) {
    const double h = 0.5 * (a + b);
    const double excess = 2 * (cl - std::sqrt(k_g * h)) - (h - low) * std::sqrt(0.5 * k_g * (h + low) / (h * low));
    (excess > 0 ? a : b) = h;
  }
  const double hm = a, um = 2 * (cl - std::sqrt(k_g * hm)), shock = um * hm / (hm - low);
  EXPECT_NEAR(hm, 0.3962, 1e-4);
  const auto exact = [&](double x, double t) {
    if (x < -cl * t) return 1.0;
    if (x < (um - std::sqrt(k_g * hm)) * t) return (2 * cl - x / t) * (2 * cl - x / t) / (9 * k_g);
    return x < shock * t ? hm : low;
  };
  const Dam coarse = dam(200, 1, low, 0.8, exact), fine = dam(400, 1, low, 0.8, exact);
  EXPECT_LT(fine.error, 0.002);
  EXPECT_LT(fine.error, 0.7 * coarse.error);
}

TEST(ShallowWaves, Water_swings_in_a_bowl_as_Thacker_says_slow) {
  // Thacker (1981), flat surface: h = H - r^2 curve, the surface tilts and turns with omega^2 = 2 g H / a^2.
  const int n = 128;
  const double deep = 0.1, a = 1, shift = 0.5, size = 4.0;
  ShallowSetup s = still_water(n, n, size / n, 0);
  s.origin = Vec2(-size / 2, -size / 2);
  set_bed(s, [&](double x, double z) { return -deep * (1 - (x * x + z * z) / (a * a)); });
  const double omega = std::sqrt(2 * k_g * deep) / a, period = 2 * k_pi / omega;
  const auto exact = [&](double x, double z, double t) {
    const double bed = -deep * (1 - (x * x + z * z) / (a * a));
    const double level = shift * deep / (a * a) * (2 * x * std::cos(omega * t) + 2 * z * std::sin(omega * t) - shift);
    return std::max(0.0, level - bed);
  };
  set_depth(s, [&](double x, double z) { return exact(x, z, 0); });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  // It starts with u = -shift omega sin, w = shift omega cos: at t = 0 along z.
  auto& w = state.block("w");
  for (int k = 1; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      const std::size_t row = at(n + 5), c = at(k + 2) * row + at(i + 2);
      const auto& h = *state.find("depth");
      if (h[c] > 0 && h[c - row] > 0) w[c] = shift * omega;
    }
  const double volume = solver.ledger(state).total();
  double lowest = 0;
  for (int f = 0; f < 60; ++f) lowest = std::min(lowest, solver.advance_frame(state, period / 60).lowest_depth);
  const auto depth = solver.depths(state);
  double error = 0, water = 0;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      const double h = exact(s.origin.x() + (i + 0.5) * s.cell, s.origin.y() + (k + 0.5) * s.cell, period);
      error += std::abs(depth[at(i) + at(n) * at(k)] - h), water += h;
    }
  RecordProperty("L1_percent", std::to_string(100 * error / water));
  EXPECT_LT(error / water, 0.03);
  EXPECT_EQ(lowest, 0);
  EXPECT_NEAR(solver.ledger(state).total(), volume, 1e-12 * volume);
}

TEST(ShallowWaves, A_lake_over_bumps_and_around_islands_stays_at_rest) {
  ShallowSetup s = still_water(60, 50, 0.1, 0.3);
  set_bed(s, [](double x, double z) {
    return 0.25 * std::sin(3 * x) * std::cos(2 * z) + (std::hypot(x - 2, z - 3) < 0.7 ? 0.5 : 0) +
           0.02 * std::sin(40 * x);
  });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  int dry = 0;
  for (const double h : solver.depths(state)) dry += h == 0 ? 1 : 0;
  EXPECT_GT(dry, 50);
  for (int f = 0; f < 48; ++f) solver.advance_frame(state, 1.0 / 24);
  const auto depth = solver.depths(state), surface = solver.surface(state);
  double off = 0, speed = 0;
  for (std::size_t n = 0; n < depth.size(); ++n)
    if (depth[n] > 0) off = std::max(off, std::abs(surface[n] - 0.3));
  for (const Vec2& v : solver.velocities(state)) speed = std::max(speed, v.norm());
  EXPECT_LT(off, 1e-12);
  EXPECT_LT(speed, 1e-12);
}

TEST(ShallowWaves, A_closed_basin_keeps_its_volume_through_ten_thousand_steps) {
  ShallowSetup s = still_water(40, 30, 0.05, 0.05);
  set_bed(s, [](double x, double z) { return 0.04 * std::sin(4 * x) + 0.05 * z; });
  set_depth(s, [](double x, double z) { return x < 0.6 && z < 0.8 ? 0.2 : 0; });
  s.manning = 0.01, s.viscosity = 1e-6;
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  const double volume = solver.ledger(state).total();
  int steps = 0;
  double lowest = 0;
  while (steps < 10000) {
    const ShallowReport r = solver.advance_frame(state, 0.5);
    steps += r.steps;
    lowest = std::min(lowest, r.lowest_depth);
    ASSERT_TRUE(r.finite);
  }
  EXPECT_NEAR(solver.ledger(state).total(), volume, 1e-12 * volume);
  EXPECT_GE(lowest, 0);
}

TEST(ShallowWaves, A_wave_leaves_over_an_open_edge_and_the_account_says_how_much) {
  for (const ShallowEdge edge : {ShallowEdge::k_open, ShallowEdge::k_wall}) {
    ShallowSetup s = still_water(200, 1, 0.02, 0.1);
    s.edges[1] = edge;
    set_depth(s, [](double x, double) { return 0.1 + 0.002 * std::exp(-(x - 2) * (x - 2) / 0.02); });
    s.level = 0.1;
    ShallowSolver solver = solver_of(s);
    State state = solver.initial_state();
    const double volume = solver.ledger(state).total();
    for (int f = 0; f < 60; ++f) solver.advance_frame(state, 1.0 / 20);
    // The half that went to the right has gone by; from a wall it comes back and is at 3 m after 3 s.
    const auto depth = solver.depths(state);
    double crest = 0;
    for (int i = 120; i < 200; ++i) crest = std::max(crest, std::abs(depth[at(i)] - 0.1));
    if (edge == ShallowEdge::k_open)
      EXPECT_LT(crest, 0.05 * 0.001);
    else
      EXPECT_GT(crest, 0.5 * 0.001);
    EXPECT_NEAR(solver.ledger(state).total(), volume, 1e-12 * volume);
    EXPECT_EQ(solver.ledger(state).outflow != 0, edge == ShallowEdge::k_open);
  }
}

TEST(ShallowWaves, Water_pours_over_a_dry_open_edge) {
  ShallowSetup s = still_water(50, 1, 0.02, 0.1);
  s.edges[1] = ShallowEdge::k_open;
  set_depth(s, [](double x, double) { return x < 0.5 ? 0.1 : 0; });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  const double volume = solver.ledger(state).total();
  for (int f = 0; f < 24 * 5; ++f) solver.advance_frame(state, 1.0 / 24);
  EXPECT_GT(solver.ledger(state).outflow, 0.8 * volume);
  EXPECT_NEAR(solver.ledger(state).total(), volume, 1e-12 * volume);
}

TEST(ShallowWaves, A_sheet_on_a_slope_goes_at_the_speed_of_Manning) {
  // v = h^(2/3) sqrt(slope) / n, once weight and friction balance; here in a long channel far from its ends.
  const double slope = 0.01, deep = 0.02, manning = 0.02;
  ShallowSetup s = still_water(400, 1, 0.05, 0);
  s.manning = manning;
  s.edges[1] = ShallowEdge::k_open;
  set_bed(s, [&](double x, double) { return -slope * x; });
  set_depth(s, [&](double, double) { return deep; });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  for (int f = 0; f < 24 * 12; ++f) solver.advance_frame(state, 1.0 / 24);
  const double expected = std::pow(deep, 2.0 / 3) * std::sqrt(slope) / manning;
  EXPECT_NEAR(solver.velocities(state)[250].x(), expected, 0.02 * expected);
  EXPECT_NEAR(solver.depths(state)[250], deep, 0.02 * deep);
}

TEST(ShallowWaves, Ground_that_was_wet_stays_marked_and_dries) {
  ShallowSetup s = still_water(60, 1, 0.02, 0);
  s.drying_time = 2;
  s.edges[1] = ShallowEdge::k_open;
  set_bed(s, [](double x, double) { return x > 0.8 ? 0.0 : 0.3 * (0.8 - x); });
  set_depth(s, [](double x, double) { return x < 0.3 ? 0.01 : 0; });
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  EXPECT_EQ(solver.wet(state)[40], 0);
  double before = 1;
  bool dries = false;
  for (int f = 0; f < 24 * 6; ++f) {
    solver.advance_frame(state, 1.0 / 24);
    const double now = solver.wet(state)[2];
    EXPECT_GE(now, 0);
    if (now < 1 && before <= 1 && now < before) {
      dries = true;
      EXPECT_NEAR(now / before, std::exp(-1.0 / 24 / 2), 1e-12);
    }
    before = now;
  }
  EXPECT_TRUE(dries);
}

TEST(ShallowWaves, Patches_and_whole_agree_on_a_splash_of_fast_water) {
  // A jet in one corner of still water: the patch takes the short steps. Volume to rounding, depths near those of a run
  // whose long steps are all short.
  ShallowSetup s = still_water(160, 160, 0.02, 0.02);
  set_depth(s, [](double x, double z) { return std::hypot(x - 0.5, z - 0.5) < 0.1 ? 0.4 : 0.02; });
  ShallowSolver solver = solver_of(s);
  State patched = solver.initial_state(), whole = solver.initial_state();
  const double volume = solver.ledger(whole).total();
  int patch_steps = 0;
  for (int f = 0; f < 6; ++f) {
    patch_steps += solver.advance_frame(patched, 1.0 / 24).patch_steps;
    for (int n = 0; n < 24; ++n) solver.advance_frame(whole, 1.0 / 576);
  }
  EXPECT_GT(patch_steps, 10);
  EXPECT_NEAR(solver.ledger(patched).total(), volume, 1e-12 * volume);
  const auto a = solver.depths(patched), b = solver.depths(whole);
  double difference = 0, wave = 0;
  for (std::size_t n = 0; n < a.size(); ++n) difference += std::abs(a[n] - b[n]), wave += std::abs(b[n] - 0.02);
  EXPECT_LT(difference, 0.05 * wave);
}

}  // namespace
}  // namespace ft

// A foot that comes down in a puddle; splash, the account of the water, the same bytes.
#include <numbers>

#include "baker/core/parallel.h"
#include "tests/solvers/shallow_scenes.h"

namespace ft {
namespace {

using namespace test;

constexpr double k_film = 2e-3, k_deep = 0.02, k_sole_x = 0.26, k_sole_z = 0.09;

/// A sole of 26 x 9 cm that comes down at 3 m/s until 2 mm are left under it, at the end of the first frame; stays, and
/// goes up again.
Driven sole(double thick = 0.3) {
  Driven d;
  d.surface = box_surface(Vec3(k_sole_x, thick, k_sole_z));
  d.place = [thick](double t) {
    double bottom = k_film + 3 * std::max(0.0, 1.0 / 24 - t);
    if (t > 0.25) bottom += 1.5 * (t - 0.25);
    return Vec3(0, bottom + 0.5 * thick, 0);
  };
  return d;
}

ShallowSetup puddle(double cell, double wide, double long_) {
  ShallowSetup s = still_water(static_cast<int>(std::lround(wide / cell)), static_cast<int>(std::lround(long_ / cell)),
                               cell, k_deep);
  s.origin = Vec2(-wide / 2, -long_ / 2);
  s.manning = 0.012, s.viscosity = 1e-6;
  s.splash.on = true;
  return s;
}

struct Stomp {
  double thrown = 0, rim = 0, lowest = 0, worst_volume = 0;
  int failed = 0;
};
Stomp stomp(double cell, int frames) {
  const ShallowSetup s = puddle(cell, 0.96, 0.8);
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  const double volume = solver.ledger(state).total();
  Driven foot = sole();
  Stomp out;
  for (int f = 0; f < frames; ++f) {
    const DrivenBody body = foot.frame(f / 24.0, (f + 1) / 24.0);
    const ShallowReport r = solver.advance_frame(state, 1.0 / 24, {&body, 1});
    out.thrown += r.volume_thrown;
    out.rim = std::max(out.rim, r.rim_fastest);
    out.lowest = std::min(out.lowest, r.lowest_depth);
    out.failed += r.failed_solves;
    out.worst_volume = std::max(out.worst_volume, std::abs(r.ledger.total() - volume) / volume);
    EXPECT_TRUE(r.finite);
  }
  return out;
}

TEST(ShallowFoot, A_foot_in_a_puddle_throws_as_much_whatever_the_cells_slow) {
  const Stomp coarse = stomp(0.01, 12), fine = stomp(0.005, 12);
  const double under = k_sole_x * k_sole_z * k_deep;
  for (const Stomp* s : {&coarse, &fine}) {
    RecordProperty(s == &coarse ? "thrown_percent_10mm" : "thrown_percent_5mm",
                   std::to_string(100 * s->thrown / under));
    RecordProperty(s == &coarse ? "rim_10mm" : "rim_5mm", std::to_string(s->rim));
    EXPECT_GE(s->lowest, 0);
    EXPECT_EQ(s->failed, 0);
    EXPECT_LT(s->worst_volume, 1e-12);
    EXPECT_GT(s->rim, 0.6 * 14);  // faster than what the contact bears it is never
    EXPECT_GT(s->thrown / under, 0.05);
  }
  EXPECT_NEAR(coarse.thrown / fine.thrown, 1, 0.2);
}

TEST(ShallowFoot, A_foot_leaves_a_dry_print_that_the_water_comes_back_to) {
  ShallowSetup s = puddle(0.01, 0.96, 0.8);
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  Driven foot = sole();
  std::vector<double> under;
  double peak = 0;
  for (int f = 0; f < 36; ++f) {
    const DrivenBody body = foot.frame(f / 24.0, (f + 1) / 24.0);
    const ShallowReport r = solver.advance_frame(state, 1.0 / 24, {&body, 1});
    under.push_back(solver.depths(state)[48 + 96 * 40]);
    peak = std::max(peak, r.driven[0].peak.force.y());
  }
  // What is under the sole rushes out, and there is no suction to bring it back before the foot has left.
  EXPECT_LE(under[5], k_film);
  EXPECT_GT(under[35], 0.008);
  // The cap is what a sole bears.
  EXPECT_GT(peak, 300);
  EXPECT_LT(peak, 1.05 * s.contact_pressure * k_sole_x * k_sole_z);
}

TEST(ShallowFoot, Volume_in_columns_in_the_air_and_outside_adds_up_through_a_bake) {
  ShallowSetup s = puddle(0.01, 0.48, 0.4);
  s.edges.fill(ShallowEdge::k_open);
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  const double volume = solver.ledger(state).total();
  Driven foot = sole();
  bool flew = false;
  for (int f = 0; f < 84; ++f) {
    const DrivenBody body = foot.frame(f / 24.0, (f + 1) / 24.0);
    const ShallowReport r = solver.advance_frame(state, 1.0 / 24, {&body, 1});
    flew = flew || r.ledger.droplets > 0;
    EXPECT_NEAR(r.ledger.total(), volume, 1e-12 * volume) << f;
    double drops = 0;
    for (const Droplet& d : solver.droplets(state)) drops += d.volume;
    EXPECT_NEAR(drops, r.ledger.droplets, 1e-15);
  }
  EXPECT_TRUE(flew);
  EXPECT_GT(solver.ledger(state).outflow, 0);
  EXPECT_EQ(solver.ledger(state).droplets, 0);
}

TEST(ShallowFoot, Shells_that_overlap_and_are_open_at_the_top_are_one_body) {
  // The same sole, as two boxes that overlap and have no lids.
  ShallowSetup s = puddle(0.01, 0.6, 0.48);
  s.splash.on = false;
  ShallowSolver solver = solver_of(s);
  Driven whole = sole(), parts;
  parts.place = whole.place;
  for (const double side : {-1.0, 1.0}) {
    TriangleSurface half = box_surface(Vec3(0.16, 0.3, k_sole_z));
    const int base = static_cast<int>(parts.surface.positions.size());
    for (const Vec3& p : half.positions) parts.surface.positions.push_back(p + Vec3(side * 0.05, 0, 0));
    for (const Triangle& t : half.triangles) {
      const Vec3 &a = half.positions[at(t[0])], &b = half.positions[at(t[1])], &c = half.positions[at(t[2])];
      if ((b - a).cross(c - a).y() <= 1e-9) parts.surface.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
  }
  ASSERT_EQ(parts.surface.triangles.size(), 20u);
  State a = solver.initial_state(), b = solver.initial_state();
  for (int f = 0; f < 4; ++f) {
    const DrivenBody one = whole.frame(f / 24.0, (f + 1) / 24.0), two = parts.frame(f / 24.0, (f + 1) / 24.0);
    solver.advance_frame(a, 1.0 / 24, {&one, 1});
    solver.advance_frame(b, 1.0 / 24, {&two, 1});
  }
  const auto da = solver.depths(a), db = solver.depths(b);
  double difference = 0;
  for (std::size_t n = 0; n < da.size(); ++n) difference = std::max(difference, std::abs(da[n] - db[n]));
  EXPECT_LT(difference, 1e-6);
  EXPECT_GT(std::abs(da[30 + 60 * 10] - k_deep), 1e-5);
}

TEST(ShallowFoot, The_same_bytes_with_one_thread_and_two_and_after_a_resume) {
  ShallowSetup s = puddle(0.01, 0.96, 0.8);
  s.floats.push_back(floating("ball", sphere_surface(0.04, 2), 300, Vec3(0.3, 0.03, 0.25), 0.47));
  Driven foot = sole();
  const auto bake = [&](int threads, bool resume) {
    ThreadLimit limit(threads);
    auto solver = std::make_unique<ShallowSolver>(solver_of(s));
    State state = solver->initial_state();
    for (int f = 0; f < 10; ++f) {
      const DrivenBody body = foot.frame(f / 24.0, (f + 1) / 24.0);
      solver->advance_frame(state, 1.0 / 24, {&body, 1});
      if (!resume) continue;
      auto loaded = load_state(save(state));
      EXPECT_TRUE(loaded.ok());
      state = std::move(loaded).value();
      solver = std::make_unique<ShallowSolver>(solver_of(s));
    }
    return hash(state).hex();
  };
  const std::string first = bake(1, false);
  EXPECT_EQ(first, bake(2, false));
  EXPECT_EQ(first, bake(2, true));
}

TEST(ShallowFoot, A_body_that_stands_in_the_water_at_the_start_only_takes_its_place) {
  ShallowSetup s = puddle(0.01, 0.6, 0.48);
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  const double volume = solver.ledger(state).total();
  Driven foot = sole();
  foot.place = [](double) { return Vec3(0, 0.15 + 0.005, 0); };
  for (int f = 0; f < 12; ++f) {
    const DrivenBody body = foot.frame(f / 24.0, (f + 1) / 24.0);
    const ShallowReport r = solver.advance_frame(state, 1.0 / 24, {&body, 1});
    EXPECT_LT(r.fastest, 0.23);  // half of sqrt(g h) is 0.2215
    EXPECT_NEAR(r.driven[0].mean.force.y(), 1000 * k_g * 0.015 * k_sole_x * k_sole_z, 0.1);
    EXPECT_NEAR(r.ledger.total(), volume, 1e-12 * volume);
  }
  EXPECT_NEAR(solver.ledger(state).outflow, 0.015 * k_sole_x * k_sole_z, 1e-9);
}

}  // namespace
}  // namespace ft

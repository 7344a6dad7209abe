// The water of O'Brien and Hodgins (1995): its waves are as fast as theirs should be, alike in all directions; nothing
// is lost; what floats displaces its weight; and what the model gets wrong is what is written of it.
#include <gtest/gtest.h>

#include "baker/core/parallel.h"
#include "baker/core/shapes.h"
#include "solvers/water/hydrostatics.h"
#include "solvers/water/paper/paper_solver.h"
#include "tests/solvers/water_scenes.h"

namespace ft::test {
namespace {

PaperSetup still(int nx, int nz, double cell, double level) {
  PaperSetup s;
  s.nx = nx, s.nz = nz, s.cell = cell, s.level = level;
  s.gravity = k_g;
  s.splash.on = false;
  return s;
}

PaperSolver paper(const PaperSetup& s) {
  auto made = PaperSolver::make(s);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().text());
  return std::move(made).value();
}

double height_of_bed(double x, double z) {
  // A bump under water, an island above it.
  return 0.3 * std::exp(-20 * ((x - 0.4) * (x - 0.4) + (z - 0.5) * (z - 0.5))) +
         0.8 * std::exp(-20 * ((x - 1.4) * (x - 1.4) + (z - 0.4) * (z - 0.4)));
}

TEST(PaperWaves, A_basin_swings_with_its_period) {
  for (const bool along_x : {true, false}) {
    PaperSetup s = still(along_x ? 64 : 6, along_x ? 6 : 64, 2.0 / 64, 0.5);
    set_depth(s, [&](double x, double z) { return 0.5 + 1e-4 * std::cos(std::numbers::pi * (along_x ? x : z) / 2); });
    PaperSolver water = paper(s);
    State state = water.initial_state();
    const double frame = 1 / 200.0;
    double before = 1e-4, first = 0, last = 0;
    int count = 0;
    for (int f = 1; count < 9; ++f) {
      water.advance_frame(state, frame);
      const double now = water.depths(state)[0] - 0.5;
      if (now * before < 0) {
        last = frame * (f - now / (now - before));
        if (count++ == 0) first = last;
      }
      before = now;
    }
    EXPECT_NEAR((last - first) / 4, 1.80609, 1e-3 * 1.80609);
  }
}

TEST(PaperWaves, Run_alike_along_the_axes_and_across_the_corners) {
  PaperSetup s = still(120, 120, 0.05, 0.5);
  set_depth(s, [](double x, double z) {
    return 0.5 + 1e-3 * std::exp(-(std::pow(x - 3, 2) + std::pow(z - 3, 2)) / (2 * 0.15 * 0.15));
  });
  PaperSolver water = paper(s);
  State state = water.initial_state();
  const double time = 1;
  for (int f = 0; f < 24; ++f) water.advance_frame(state, time / 24);
  const std::vector<double> depth = water.depths(state);
  // Where the ring's crest is along a ray, by bilinear reading and a parabola through the highest.
  const auto crest = [&](double turn) {
    const auto read = [&](double r) {
      const double x = 60 + r * std::cos(turn) - 0.5, z = 60 + r * std::sin(turn) - 0.5;
      const int i = static_cast<int>(x), k = static_cast<int>(z);
      const double a = x - i, b = z - k;
      const auto at_cell = [&](int di, int dk) { return depth[at(i + di) + 120 * at(k + dk)]; };
      return (1 - b) * ((1 - a) * at_cell(0, 0) + a * at_cell(1, 0)) +
             b * ((1 - a) * at_cell(0, 1) + a * at_cell(1, 1));
    };
    double best = 20;
    for (double r = 20; r < 58; r += 0.25)
      if (read(r) > read(best)) best = r;
    const double low = read(best - 1), mid = read(best), high = read(best + 1);
    return 0.05 * (best + 0.5 * (low - high) / (low - 2 * mid + high));
  };
  const double axis = crest(0), corner = crest(std::numbers::pi / 4);
  EXPECT_NEAR(corner / axis, 1, 0.01) << axis << " " << corner;
  EXPECT_NEAR(axis / (std::sqrt(k_g * 0.5) * time), 1, 0.1) << "the crest of a ring runs a little behind its front";
}

TEST(PaperWaves, A_lake_over_bumps_and_around_an_island_rests) {
  PaperSetup s = still(40, 20, 0.05, 0.5);
  set_bed(s, height_of_bed);
  PaperSolver water = paper(s);
  State state = water.initial_state();
  const std::vector<double> start = water.depths(state);
  WaterReport report;
  for (int f = 0; f < 48; ++f) report = water.advance_frame(state, 1 / 24.0);
  const std::vector<double> end = water.depths(state);
  int dry = 0;
  for (std::size_t c = 0; c < end.size(); ++c) {
    EXPECT_NEAR(end[c], start[c], 1e-12);
    dry += start[c] == 0 ? 1 : 0;
  }
  EXPECT_GT(dry, 5);
  EXPECT_LT(*report.fastest, 1e-12);
}

TEST(PaperWaves, A_dam_breaks_as_the_model_does_it_and_not_as_water_does) {
  PaperSetup s = still(400, 1, 0.05, 1);
  set_depth(s, [](double x, double) { return x < 10 ? 1.0 : 0.0; });
  PaperSolver water = paper(s);
  State state = water.initial_state();
  for (int f = 0; f < 24; ++f) water.advance_frame(state, 0.05);
  const std::vector<double> depth = water.depths(state);
  double middle = 0, front = 0;
  for (std::size_t c = 190; c < 210; ++c) middle += depth[c] / 20;
  for (std::size_t c = 200; c < 400; ++c)
    if (depth[c] > 1e-3) front = 0.05 * static_cast<double>(c - 200);
  EXPECT_NEAR(middle, 0.55, 0.03) << "4/9 is right";
  EXPECT_NEAR(front, 3.0, 0.2) << "7.5 is right";
  for (const double d : depth) EXPECT_GE(d, 0);
}

TEST(PaperWaves, Leave_over_open_edges) {
  PaperSetup s = still(60, 60, 0.05, 0.5);
  s.edges.fill(PaperEdge::k_open);
  set_depth(s, [](double x, double z) {
    return 0.5 + 1e-2 * std::exp(-(std::pow(x - 1.5, 2) + std::pow(z - 1.5, 2)) / (2 * 0.2 * 0.2));
  });
  PaperSolver water = paper(s);
  State state = water.initial_state();
  const double all = water.ledger(state).total();
  WaterReport report;
  for (int f = 0; f < 72; ++f) report = water.advance_frame(state, 1 / 24.0);
  double highest = 0;
  for (const double d : water.depths(state)) highest = std::max(highest, std::abs(d - 0.5));
  EXPECT_LT(highest, 2e-4);
  EXPECT_GT(report.ledger.outflow, 0);
  EXPECT_NEAR(report.ledger.total(), all, 1e-12 * all);
}

TEST(PaperBodies, A_ball_at_its_draft_rests_and_one_above_it_bobs_until_it_displaces_its_weight) {
  const TriangleSurface ball = sphere_surface(0.15, 3);
  for (const double density : {200.0, 500.0, 800.0}) {
    PaperSetup s = still(30, 30, 0.05, 0.5);
    s.edges.fill(PaperEdge::k_open);
    s.floats = {floating("ball", ball, density, Vec3(0.75, 0, 0.75), 0.47)};
    const FloatingBody& body = s.floats[0].body;
    const double want = body.mass.mass / 1000;
    double lo = 0.3, hi = 0.7;
    for (int n = 0; n < 60; ++n) {
      const double y = 0.5 * (lo + hi);
      std::vector<Vec3> x;
      for (const Vec3& p : body.positions) x.push_back(p + Vec3(0.75, y, 0.75));
      (hydrostatics(x, body.triangles, 0.5, 1, Vec3::Zero()).volume > want ? lo : hi) = y;
    }
    s.floats[0].start.pose.position.y() = lo;
    PaperSolver rests = paper(s);
    State state = rests.initial_state();
    for (int f = 0; f < 48; ++f) rests.advance_frame(state, 1 / 24.0);
    EXPECT_NEAR(rests.floats(state)[0].pose.position.y(), lo, 1e-9) << density;

    s.floats[0].start.pose.position.y() = lo + 0.05;
    PaperSolver bobs = paper(s);
    state = bobs.initial_state();
    double lowest = 1;
    for (int f = 0; f < 240; ++f) {
      const WaterReport report = bobs.advance_frame(state, 1 / 24.0);
      ASSERT_TRUE(report.finite);
      if (f < 24) lowest = std::min(lowest, bobs.floats(state)[0].pose.position.y());
    }
    EXPECT_LT(lowest, lo - 0.005) << "it goes below its draft";
    std::vector<Vec3> x;
    for (const Vec3& p : body.positions) x.push_back(bobs.floats(state)[0].pose * p);
    double level = 0;
    const std::vector<double> depth = bobs.depths(state);
    for (std::size_t i = 0; i < 30; ++i) level += depth[i] / 30;
    const double share = hydrostatics(x, body.triangles, level, 1, Vec3::Zero()).volume / want;
    RecordProperty("displaced", std::to_string(share));
    EXPECT_NEAR(share, 1, 0.01) << density;
  }
}

PaperSetup splashing() {
  PaperSetup s = still(40, 40, 0.05, 0.6);
  set_bed(s, [](double x, double) { return 0.3 * x; });
  s.splash.on = true;
  s.floats = {floating("ball", sphere_surface(0.2, 3), 500, Vec3(0.7, 1.6, 1), 0.47)};
  return s;
}

TEST(PaperSplash, Flies_and_comes_back_and_no_water_is_lost) {
  PaperSolver water = paper(splashing());
  State state = water.initial_state();
  const double all = water.ledger(state).total();
  int thrown = 0, most = 0;
  double first = 0, energy = 0;
  WaterReport report;
  for (int f = 0; f < 120; ++f) {
    report = water.advance_frame(state, 1 / 24.0);
    ASSERT_TRUE(report.finite);
    thrown += report.thrown;
    most = std::max(most, report.airborne);
    EXPECT_NEAR(report.ledger.total(), all, 1e-12 * all);
    for (const double d : water.depths(state)) ASSERT_GE(d, 0);
    if (f == 0) first = report.kinetic + report.potential;
    energy = std::max(energy, report.kinetic + report.potential);
  }
  EXPECT_GT(thrown, 50);
  EXPECT_GT(most, 20);
  EXPECT_LT(report.airborne, most / 4) << "but for what choppy water throws again";
  const double ball = 1000 * 0.5 * 4.0 / 3 * std::numbers::pi * 0.008;
  EXPECT_LT(energy - first, 0.05 * ball * k_g * 0.8) << "droplets are paid for";
}

TEST(PaperSplash, Threads_and_a_resume_change_no_byte) {
  const auto go = [](int threads, bool resumed) {
    const ThreadLimit limit(threads);
    PaperSolver water = paper(splashing());
    State state = water.initial_state();
    for (int f = 0; f < 20; ++f) {
      water.advance_frame(state, 1 / 24.0);
      if (resumed && f == 11) {
        state = load_state(save(state)).value();
        water = paper(splashing());
      }
    }
    return hash(state);
  };
  const Hash128 one = go(1, false);
  EXPECT_TRUE(one == go(4, false));
  EXPECT_TRUE(one == go(2, true));
}

TEST(PaperBodies, A_driven_block_is_pushed_up_by_what_it_displaces_and_dives_through_thin_water) {
  PaperSetup s = still(40, 40, 0.05, 0.5);
  s.edges.fill(PaperEdge::k_open);
  PaperSolver water = paper(s);
  State state = water.initial_state();
  Driven block{
      box_surface(Vec3(0.4, 0.4, 0.4)), [](double t) { return Vec3(1, 0.9 - 0.4 * std::min(t, 1.0), 1); }, {}, {}};
  WaterReport report;
  for (int f = 0; f < 120; ++f) {
    const DrivenBody body = block.frame(f / 24.0, (f + 1) / 24.0);
    report = water.advance_frame(state, 1 / 24.0, {&body, 1});
    ASSERT_TRUE(report.finite);
    for (const double d : water.depths(state)) ASSERT_GE(d, 0);
  }
  ASSERT_EQ(report.forces.size(), 1u);
  // Half of it is in the water.
  EXPECT_NEAR(report.forces[0].mean.force.y(), 1000 * k_g * 0.4 * 0.4 * 0.2, 0.01 * 1000 * k_g * 0.032);
  EXPECT_NEAR(report.forces[0].mean.force.x(), 0, 1e-3);
  EXPECT_EQ(report.forces[0].wet_share, 1);

  PaperSetup puddle = still(40, 40, 0.02, 0.02);
  puddle.viscosity = 1e-6, puddle.manning = 0.012;
  puddle.splash.on = true;
  PaperSolver thin = paper(puddle);
  state = thin.initial_state();
  const double all = thin.ledger(state).total();
  Driven sole{
      box_surface(Vec3(0.26, 0.1, 0.1)), [](double t) { return Vec3(0.4, std::max(0.05, 0.2 - 2 * t), 0.4); }, {}, {}};
  double peak = 0;
  for (int f = 0; f < 24; ++f) {
    const DrivenBody body = sole.frame(f / 24.0, (f + 1) / 24.0);
    report = thin.advance_frame(state, 1 / 24.0, {&body, 1});
    ASSERT_TRUE(report.finite);
    for (const double d : thin.depths(state)) ASSERT_GE(d, 0);
    EXPECT_NEAR(report.ledger.total(), all, 1e-12 * all);
    peak = std::max(peak, report.forces[0].peak);
  }
  EXPECT_GT(peak, 10);
}

TEST(PaperSetup, Says_all_that_is_wrong) {
  PaperSetup s = still(0, 4, -1, 0.5);
  s.stiffness = 1, s.cfl = 2;
  s.splash.smallest = 0.01;
  const auto made = PaperSolver::make(s);
  ASSERT_FALSE(made.ok());
  for (const char* words : {"0 x 4 cells", "cells of -1 m", "stiffness 1", "cfl 2", "droplets of"})
    EXPECT_NE(made.error().text().find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace ft::test

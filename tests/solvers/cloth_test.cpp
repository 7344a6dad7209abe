// The cloth solver as a whole: bodies that move under and through cloth, and the promises about state and threads.
#include <gtest/gtest.h>

#include "baker/core/parallel.h"
#include "solvers/cloth/cloth_solver.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

std::shared_ptr<ScriptedBody> spheres(const std::vector<std::function<Vec3(double)>>& paths, double radius,
                                      double preroll = 0) {
  Surface surface;
  std::vector<Vec3> points, bind;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    make_sphere(radius, 16, 24, points, surface.triangles);
    surface.part_of_vertex.resize(points.size(), static_cast<int>(k));
    surface.parts.push_back({"ball" + std::to_string(k), -1, 1.0 - 0.1 * static_cast<double>(k)});
  }
  bind = points;
  const auto place = [paths, surface, points](double time, std::span<Vec3> out) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = points[i] + paths[at(surface.part_of_vertex[i])](time);
  };
  place(-preroll, bind);
  return std::make_shared<ScriptedBody>(surface, bind, preroll, place);
}

ClothSetup sheet_on(std::shared_ptr<const Trajectory> body, int cells, double height) {
  ClothSetup setup;
  setup.primary = std::move(body);
  setup.preroll_frames = 0;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(0.8, cells, height);
  setup.garments.push_back(std::move(sheet));
  return setup;
}

std::unique_ptr<Solver> solver_of(ClothSetup setup) {
  auto solver = make_cloth_solver(std::move(setup));
  EXPECT_TRUE(solver) << (solver ? "" : solver.error().text());
  return std::move(*solver);
}

void expect_clean(const FrameReport& r) {
  EXPECT_TRUE(r.finite) << r.frame;
  EXPECT_EQ(r.crossings_body, 0) << r.frame;
  EXPECT_EQ(r.crossings_self, 0) << r.frame;
  EXPECT_GT(r.smallest_gap, 0) << r.frame;
  EXPECT_EQ(r.released_vertices, 0) << r.frame;
}

TEST(ClothSolver, takes_shorter_steps_for_cloth_that_turns_fast) {
  const auto substeps_at = [](double spin, int cells = 12) {  // rad/s, in its plane
    const ClothSetup setup = sheet_on(nullptr, cells, 0);
    auto solver = solver_of(setup);
    State state = solver->initial_state();
    std::vector<Vec3> v, v_previous;
    for (const Vec3& p : as_points(*state.find("x"))) v.push_back(Vec3(0, spin, 0).cross(p));
    for (const char* name : {"v", "v_previous"}) {
      std::vector<double>& block = state.block(name);
      for (std::size_t i = 0; i < block.size(); ++i) block[i] = v[i / 3][static_cast<int>(i % 3)];
    }
    const FrameReport report = solver->advance_frame(state);
    expect_clean(report);
    return report.substeps;
  };
  EXPECT_EQ(substeps_at(5), 3);      // a turn of 0.07 rad in each
  EXPECT_EQ(substeps_at(40), 9);     // of 0.185, for 0.56 in three
  EXPECT_EQ(substeps_at(80), 17);    // of 0.196
  EXPECT_EQ(substeps_at(5, 60), 5);  // finer cloth: 1 to 1.25 edges in each
}

TEST(ClothSolver, drapes_over_a_ball_at_rest_without_crossing_it) {
  auto solver = solver_of(sheet_on(spheres({[](double) { return Vec3(0, 0, 0); }}, 0.25), 24, 0.26));
  State state = solver->initial_state();
  FrameReport last;
  for (int f = 0; f < 36; ++f) {
    last = solver->advance_frame(state);
    expect_clean(last);
    EXPECT_LT(last.strain_p99, 0.05) << f;
  }
  std::vector<Vec3> x(at(solver->system_mesh(0).vertex_count()));
  solver->system_positions(state, 0, x);
  double lowest = 1, highest = -1;
  for (const Vec3& p : x) lowest = std::min(lowest, p.y()), highest = std::max(highest, p.y());
  EXPECT_LT(lowest, 0.0);              // the corners hang down
  EXPECT_NEAR(highest, 0.253, 0.003);  // the top lies at the contact distance
  EXPECT_LT(last.smallest_gap, 3.1e-3);
  EXPECT_GT(last.smallest_gap, 1e-3);
}

TEST(ClothSolver, is_carried_by_a_ball_that_swings_and_jumps_slow) {
  const auto path = [](double t) {
    return Vec3(0.3 * std::sin(2 * std::numbers::pi * t), t > 1 ? 0.2 * std::abs(std::sin(9 * (t - 1))) : 0, 0);
  };
  auto solver = solver_of(sheet_on(spheres({path}, 0.25), 24, 0.26));
  State state = solver->initial_state();
  for (int f = 0; f < 48; ++f) expect_clean(solver->advance_frame(state));
}

TEST(ClothSolver, keeps_a_falling_sheet_whole_when_a_fast_ball_hits_it) {
  // 12 m/s: half a metre per frame, twice the ball.
  const auto path = [](double t) { return Vec3(0, -0.2, -1.5 + 12 * t); };
  ClothSetup setup = sheet_on(spheres({path}, 0.12), 20, 0);
  for (Vec3& p : setup.garments[0].mesh.positions) p = Vec3(p.x(), -0.4 + p.z(), 0);
  auto solver = solver_of(std::move(setup));
  State state = solver->initial_state();
  for (int f = 0; f < 8; ++f) expect_clean(solver->advance_frame(state));
  std::vector<Vec3> x(at(solver->system_mesh(0).vertex_count()));
  solver->system_positions(state, 0, x);
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : x) mean += p / static_cast<double>(x.size());
  EXPECT_GT(mean.z(), 0.5);  // swept along, not passed through
}

TEST(ClothSolver, leaves_room_between_two_balls_that_close_on_the_cloth_slow) {
  const auto closing = [](double sign) {
    return [sign](double t) { return Vec3(sign * (0.32 - 0.14 * (0.5 - 0.5 * std::cos(2 * t))), 0, 0); };
  };
  ClothSetup setup = sheet_on(spheres({closing(1), closing(-1)}, 0.25), 24, 0);
  for (Vec3& p : setup.garments[0].mesh.positions) p = Vec3(0, p.x(), p.z());
  setup.gravity.setZero();
  auto solver = solver_of(std::move(setup));
  State state = solver->initial_state();
  for (int f = 0; f < 60; ++f) expect_clean(solver->advance_frame(state));
}

TEST(ClothSolver, frees_cloth_that_starts_inside_the_body_during_the_preroll) {
  auto body = spheres({[](double) { return Vec3(0, 0, 0); }}, 0.25, 1.0);
  ClothSetup setup = sheet_on(body, 24, 0.24);  // 10 mm inside the top
  setup.preroll_frames = 24;
  auto solver = solver_of(std::move(setup));
  State state = solver->initial_state();
  FrameReport last;
  for (int f = 0; f < 30; ++f) {
    last = solver->advance_frame(state);
    EXPECT_EQ(last.crossings_body, 0) << f;
  }
  EXPECT_EQ(last.crossings_drawn, 0);
  EXPECT_LT(last.deepest_drawn, 1e-4);
}

TEST(ClothSolver, takes_pinned_vertices_where_the_body_takes_them) {
  const auto path = [](double t) { return Vec3(t < 0.5 ? 0 : 0.4 * (t - 0.5), 0, 0); };
  ClothSetup setup = sheet_on(spheres({path}, 0.25), 16, 0.26);
  ClothPin pin;
  pin.vertices = {8 * 17 + 8};
  setup.garments[0].pins.push_back(pin);
  auto solver = solver_of(std::move(setup));
  State state = solver->initial_state();
  for (int f = 0; f < 36; ++f) expect_clean(solver->advance_frame(state));
  std::vector<Vec3> x(at(solver->system_mesh(0).vertex_count()));
  solver->system_positions(state, 0, x);
  EXPECT_LT((x[8 * 17 + 8] - (path(1.5) + Vec3(0, 0.26, 0))).norm(), 5e-3);
}

TEST(ClothSolver, gives_the_same_bits_for_any_number_of_threads_and_from_a_saved_state) {
  const auto path = [](double t) { return Vec3(0.2 * std::sin(6 * t), 0, 0); };
  const auto setup = sheet_on(spheres({path}, 0.25), 40, 0.254);
  std::vector<Hash128> expected;
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    auto solver = solver_of(setup);
    State state = solver->initial_state();
    std::vector<Hash128> hashes;
    for (int f = 0; f < 5; ++f) {
      if (f == 3 && threads == 8) {
        solver = solver_of(setup);  // nothing may live outside the state
        auto loaded = load_state(save(state));
        ASSERT_TRUE(loaded);
        state = *loaded;
      }
      solver->advance_frame(state);
      hashes.push_back(hash(state));
    }
    if (expected.empty()) expected = hashes;
    EXPECT_EQ(hashes, expected) << threads;
  }
}

TEST(ClothSolver, refuses_a_setup_that_cannot_be_solved) {
  ClothSetup none;
  EXPECT_FALSE(make_cloth_solver(none));
  ClothSetup bad_pin = sheet_on(nullptr, 4, 0);
  bad_pin.garments[0].pins.push_back({{}, {25}, {}});
  EXPECT_FALSE(make_cloth_solver(bad_pin));
  ClothSetup not_finite = sheet_on(nullptr, 4, 0);
  not_finite.garments[0].mesh.positions[3].x() = std::nan("");
  EXPECT_FALSE(make_cloth_solver(not_finite));
}

}  // namespace
}  // namespace ft

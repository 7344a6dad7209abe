// Leaves on the ground and against bodies: none in them, none creeps, all come to rest, and go when the wind says so.
#include "baker/core/parallel.h"
#include "collision/check/crossings.h"
#include "solvers/leaves/leaf_sleep.h"
#include "tests/solvers/leaf_scenes.h"

namespace ft {
namespace {

using namespace test;

TEST(Leaves, Nothing_falls_through_a_ground_a_box_and_a_moving_capsule_slow) {
  LeavesSetup setup = many_leaves(500, 1.2, 0.06, 0.3);
  const TriangleSurface box = box_surface(Vec3(0.5, 0.3, 0.4)), capsule = capsule_surface(0.12, 0.5, 2);
  setup.grounds.push_back({});
  setup.bodies.push_back(obstacle_of("box", box, Vec3(-0.3, 0.16, 0.1)));
  // It walks about for three seconds and stands still then.
  const auto way = [](double t) {
    const double s = std::min(t, 3.0);
    return Vec3(0.6 * std::sin(2.5 * s), 0.1 * std::sin(4 * s), 0.5 * std::sin(1.7 * s));
  };
  setup.bodies.push_back(obstacle_of("capsule", capsule, Vec3(0.3, 0.5, -0.2), way));
  const auto bodies = setup.bodies;
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  const auto triangles = surface_of(*solver).triangles;
  double awake = 500, brought_out = 0, ms = 0;
  int frame = 0;
  for (; frame < 24 * 15 && awake > 0; ++frame) {
    const FrameReport report = solver->advance_frame(state);
    ms = std::max(ms, 1e3 * report.profile.total);
    awake = report.own.at("leaves_awake");
    brought_out += report.own.at("leaves_brought_out");
    ASSERT_TRUE(report.finite);
    ASSERT_EQ(report.crossings_body, 0) << frame;
    ASSERT_EQ(report.inside_body, 0) << frame;
    const std::vector<Vec3> x = cached_vertices(*solver, state);
    for (const Vec3& p : x) ASSERT_GT(p.y(), 0) << frame;
    if (frame % 4 != 0) continue;
    for (const LeafObstacle& body : bodies) {
      std::vector<Vec3> y(at(body.trajectory->surface().vertex_count()));
      body.trajectory->sample(state.time, y);
      ASSERT_TRUE(crossings_between(x, triangles, y, body.trajectory->surface().triangles).empty()) << frame;
    }
    if (frame % 24 == 0 && std::getenv("FT_PRINT"))
      printf("frame %d awake %.0f out %.0f e %.2g ms %.1f\n", frame, awake, brought_out, report.kinetic_energy,
             1e3 * report.profile.total);
  }
  EXPECT_EQ(awake, 0);
  EXPECT_LT(frame, 24 * 15);
  RecordProperty("frames", frame);
  printf("all asleep after %d frames, %.0f brought out, slowest frame %.1f ms\n", frame, brought_out, ms);
}

/// An open surface that faces upwards: hills of a metre, 5 cm high.
TriangleSurface hills(double side, int cells) {
  const Mesh sheet = make_sheet(side, cells, 0);
  TriangleSurface out{sheet.positions, triangulate(sheet)};
  for (Vec3& p : out.positions) p.y() = 0.05 * std::sin(6 * p.x()) * std::cos(5 * p.z());
  if ((out.positions[at(out.triangles[0][1])] - out.positions[at(out.triangles[0][0])])
          .cross(out.positions[at(out.triangles[0][2])] - out.positions[at(out.triangles[0][0])])
          .y() < 0)
    for (Triangle& t : out.triangles) std::swap(t[1], t[2]);
  return out;
}

TEST(Leaves, Leaves_lie_still_on_a_meshed_ground_slow) {
  LeavesSetup setup = many_leaves(200, 0.8, 0.08, 0.3);
  const TriangleSurface ground = hills(8, 60);
  setup.bodies.push_back(obstacle_of("hills", ground, Vec3::Zero()));
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  const auto triangles = surface_of(*solver).triangles;
  std::vector<Vec3> x;
  double awake = 200, brought_out = 0, ms = 0;
  int frame = 0;
  for (; frame < 24 * 15 && awake > 0; ++frame) {
    const FrameReport report = solver->advance_frame(state);
    awake = report.own.at("leaves_awake");
    brought_out += report.own.at("leaves_brought_out");
    ms = std::max(ms, 1e3 * report.profile.total);
    ASSERT_EQ(report.crossings_body, 0) << frame;
    if (frame % 6 != 0) continue;
    x = cached_vertices(*solver, state);
    ASSERT_TRUE(crossings_between(x, triangles, ground.positions, ground.triangles).empty()) << frame;
  }
  for (const Vec3& p : x) EXPECT_GT(p.y(), -0.051);
  printf("hills: all asleep after %d frames, %.0f brought out, slowest frame %.1f ms\n", frame, brought_out, ms);
  EXPECT_EQ(awake, 0);
}

TEST(Leaves, A_runner_passes_over_lying_leaves_slow) {
  LeavesSetup setup = many_leaves(5000, 0.02, 0.07, 0.05);
  setup.grounds.push_back({});
  // A leg and a trunk at 7 m/s, 0.02 m above the ground, with the air that they drag along and push aside.
  const auto way = [](double t) { return Vec3(7 * (t - 1.5) - 1.5, 0.05 * std::sin(18 * t), 0); };
  const auto air = [=](const Vec3& p, double t) {
    const Vec3 from = p - way(t);
    const double behind = -from.x(), r2 = from.z() * from.z() + 0.3 * p.y() * p.y();
    if (behind < -0.8 || behind > 12) return Vec3(0, 0, 0);
    const double width = 0.35 + 0.08 * std::max(behind, 0.0), fade = std::exp(-r2 / (width * width));
    const double strength = behind < 0 ? 1 + behind / 0.8 : 1 / (1 + 0.5 * behind);
    return Vec3(5 * strength * fade, 1.5 * strength * fade * std::sin(9 * p.x() + 7 * t),
                2 * strength * fade * std::sin(5 * p.x()));
  };
  setup.wind = wind_of(air, 8);
  setup.bodies.push_back(obstacle_of("leg", capsule_surface(0.1, 0.7, 4), Vec3(0, 0.55, 0.05), way));
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  double most_awake = 0, lifted = 0, woken = 0, slowest = 0, brought_out = 0, awake = 0;
  std::vector<double> ms;
  for (int frame = 0; frame < 24 * 8; ++frame) {
    const FrameReport report = solver->advance_frame(state);
    ASSERT_EQ(report.crossings_body + report.inside_body, 0) << frame;
    ASSERT_EQ(report.deepest_drawn, 0) << frame;
    awake = report.own.at("leaves_awake");
    lifted += report.own.at("leaves_lifted"), woken += report.own.at("leaves_woken");
    brought_out += report.own.at("leaves_brought_out");
    if (std::getenv("FT_PRINT") && frame % 8 == 0)
      printf("%d awake %.0f lifted %.0f woken %.0f fastest %.1f %.1f ms\n", frame, awake,
             report.own.at("leaves_lifted"), report.own.at("leaves_woken"), report.own.at("leaves_fastest"),
             1e3 * report.profile.total);
    if (frame < 30) continue;
    most_awake = std::max(most_awake, awake);
    ms.push_back(1e3 * report.profile.total);
    slowest = std::max(slowest, ms.back());
  }
  std::nth_element(ms.begin(), ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2), ms.end());
  printf(
      "runner: at most %.0f awake, %.0f lifted, %.0f met, %.0f brought out; median %.1f ms, slowest %.1f ms a frame\n",
      most_awake, lifted, woken, brought_out, ms[ms.size() / 2], slowest);
  EXPECT_GT(lifted, 100);
}

/// One leaf that lies level on the ground, as deep as it is kept.
LeavesSetup lying_leaf() {
  LeavesSetup setup = many_leaves(1, 0.02, 1, 0);
  setup.leaves[0].orientation = Quat::Identity();
  setup.mass_variation = 0;
  setup.grounds.push_back({});
  return setup;
}

TEST(Leaves, What_lies_presses_on_its_ground_with_its_weight) {
  for (const double bending : {0.0, 1e-4}) {
    LeavesSetup setup = many_leaves(20, 0.3, 1, 0);
    setup.bending = bending;
    setup.may_sleep = false;
    setup.grounds.push_back({0, 0.5, "road"});
    setup.bodies.push_back(obstacle_of("far", capsule_surface(0.1, 0.5, 1), Vec3(9, 5, 0)));
    const auto solver = solver_of(setup);
    State state = solver->initial_state();
    FrameReport report;
    for (int f = 0; f < 24 * 4; ++f) report = solver->advance_frame(state);
    double weight = 0;
    for (int leaf = 0; leaf < solver->leaf_count(); ++leaf) weight += solver->plate(leaf).mass * k_gravity;
    ASSERT_EQ(report.forces.size(), 2u);
    EXPECT_EQ(report.forces[0].primary, "far");
    EXPECT_EQ(report.forces[0].contact_share, 0);
    EXPECT_EQ(report.forces[1].primary, "road");
    EXPECT_EQ(report.forces[1].contact_share, 1);
    EXPECT_NEAR(report.forces[1].mean.force.y(), -weight, 0.01 * weight) << "bending " << bending;
  }
}

TEST(Leaves, A_leaf_on_the_ground_does_not_creep) {
  LeavesSetup setup = lying_leaf();
  setup.may_sleep = false;
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  for (int f = 0; f < 48; ++f) solver->advance_frame(state);
  const LeafState before = leaves_of(*solver, state)[0];
  double farthest = 0;
  for (int f = 0; f < 240; ++f) {
    const FrameReport report = solver->advance_frame(state);
    EXPECT_EQ(report.crossings_body, 0);
    farthest = std::max(farthest, (leaves_of(*solver, state)[0].position - before.position).norm());
  }
  EXPECT_LT(farthest, 1e-4);
  printf("crept %.2e m in 10 s\n", farthest);
}

TEST(Leaves, A_lying_leaf_lifts_off_at_the_speed_that_its_threshold_says) {
  for (const double adhesion : {0.0, 0.1, 0.6}) {
    LeavesSetup setup = lying_leaf();
    setup.prototypes[0] = almond_leaf("flat", 0.08, 0.05, 0);
    setup.prototypes[0].adhesion = adhesion;
    const double expected = lift_off_speed(setup.prototypes[0], 1, 0.5);
    // Still for two seconds, then growing by 0.1 m/s each second from nine tenths of it.
    const auto speed = [=](double t) { return t < 2 ? 0.0 : 0.9 * expected + 0.1 * (t - 2); };
    setup.wind = wind_of([=](const Vec3&, double t) { return Vec3(speed(t), 0, 0); }, 100);
    const auto solver = solver_of(setup);
    State state = solver->initial_state();
    double lifted = 0;
    for (int f = 0; f < 24 * 20 && lifted == 0; ++f) {
      solver->advance_frame(state);
      if (f == 40) {
        EXPECT_TRUE(leaves_of(*solver, state)[0].asleep);
      }
      if (f > 48 && leaves_of(*solver, state)[0].position.y() > 0.03) lifted = speed(state.time);
    }
    printf("adhesion %.1f: lifts off at %.2f m/s, expected %.2f\n", adhesion, lifted, expected);
    EXPECT_NEAR(lifted, expected, 0.05 * expected) << adhesion;
  }
}

TEST(Leaves, Lying_leaves_cost_next_to_nothing) {
  LeavesSetup setup = many_leaves(5000, 0.01, 0.1, 0);
  for (Leaf& l : setup.leaves) l.asleep = true;
  setup.grounds.push_back({});
  setup.wind = wind_of([](const Vec3& p, double t) { return Vec3(1 + std::sin(p.x() + t), 0, std::cos(p.z())); }, 4);
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  std::vector<double> ms;
  for (int f = 0; f < 21; ++f) {
    const FrameReport report = solver->advance_frame(state);
    EXPECT_EQ(report.own.at("leaves_awake"), 0);
    ms.push_back(1e3 * report.profile.total);
  }
  std::nth_element(ms.begin(), ms.begin() + 10, ms.end());
  printf("5000 lying leaves: %.2f ms a frame\n", ms[10]);
  EXPECT_LT(ms[10], 20);  // 2 measured on a quiet machine; tests run on busy ones
}

}  // namespace
}  // namespace ft

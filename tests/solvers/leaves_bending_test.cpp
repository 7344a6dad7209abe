// Leaves that bend: their modes against a beam's closed form, what bends them, and that they stay out of what they
// meet.
#include "baker/core/parallel.h"
#include "solvers/leaves/leaf_bending.h"
#include "tests/solvers/leaf_scenes.h"

namespace ft {
namespace {

using namespace test;

/// A flat strip of 2 x n quads, 0.08 m x 0.02 m.
LeafPrototype strip(int n) {
  LeafPrototype out;
  out.name = "strip";
  for (int k = 0; k <= n; ++k)
    for (const double z : {-0.01, 0.0, 0.01}) out.positions.emplace_back(0.08 * k / n - 0.04, 0, z);
  for (int k = 0; k < n; ++k)
    for (const int side : {0, 1}) {
      const int a = 3 * k + side;
      out.triangles.push_back({a, a + 1, a + 4});
      out.triangles.push_back({a, a + 4, a + 3});
    }
  return out;
}

TEST(LeafBending, A_strip_in_a_vacuum_swings_with_Rayleighs_frequency_of_a_free_beam) {
  const LeafPrototype prototype = strip(60);
  const LeafShape shape = shape_of(prototype);
  PlateModel plate = plate_of(prototype, shape, 1, 1, 1e-9);
  const double stiffness = 2e-5, half = 0.04;
  LeafBending model = bending_of(shape, plate, stiffness);
  model.damping.setZero();
  Modes bent(0.02, 0), speed = Modes::Zero();
  // Of a parabola y = x^2, Rayleigh's quotient B y''^2 / (m (y - mean)^2) is 45 B / (m half length^4), beside 31.3 of
  // the exact shape.
  const double expected = std::sqrt(45 * stiffness / (prototype.mass_per_area * std::pow(half, 4)));
  const double step = 1e-3;
  int crossings = 0;
  double first = 0, last = 0;
  for (int k = 0; k < 4000; ++k) {
    const double before = bent[0];
    advance_bending(model, shape, plate, Vec3::Zero(), Vec3::Zero(), step, bent, speed);
    if (before < 0 && bent[0] >= 0) {
      last = step * (k + before / (before - bent[0]));
      if (crossings++ == 0) first = last;
    }
  }
  EXPECT_NEAR(2 * std::numbers::pi * (crossings - 1) / (last - first), expected, 0.01 * expected);
}

TEST(LeafBending, Bending_moves_no_centre_of_mass_and_keeps_the_ribs_length) {
  const LeafPrototype prototype = almond_leaf("oak", 0.08, 0.05, 0.15);
  const LeafShape shape = shape_of(prototype);
  const LeafBending model = bending_of(shape, plate_of(prototype, shape, 1, 1, 1.2), 2e-5);
  std::vector<Vec3> flat, bent;
  bend(model, shape, Modes::Zero(), flat);
  for (const Modes& modes : {Modes(1.2, 0), Modes(-0.6, 0.4), Modes(0, -0.8)}) {
    bend(model, shape, modes, bent);
    Vec3 centre = Vec3::Zero();
    for (std::size_t i = 0; i < bent.size(); ++i) centre += model.area_share[i] * bent[i];
    EXPECT_LT(centre.norm(), 1e-15);
    for (std::size_t k = 1; k + 3 < bent.size() - 1; k += 3) {  // along the rib, by the chords of its arc
      const double whole = (flat[k + 3] - flat[k]).norm(), now = (bent[k + 3] - bent[k]).norm();
      EXPECT_NEAR(now, whole, 0.01 * whole);
    }
    double farthest = 0;
    for (const Vec3& p : bent) farthest = std::max(farthest, p.norm());
    EXPECT_LT(farthest, 1.3 * shape.radius);
  }
  EXPECT_GT((bent[2] - flat[2]).norm(), 0.001) << "the halves fold";
}

TEST(LeafBending, A_leaf_that_tumbles_is_pulled_flat_and_steady_wind_does_not_bend_it) {
  const LeafPrototype prototype = almond_leaf("oak", 0.08, 0.05, 0.3);
  const LeafShape shape = shape_of(prototype);
  const PlateModel plate = plate_of(prototype, shape, 1, 1, 1.2);
  const LeafBending model = bending_of(shape, plate, 2e-5);
  Modes bent = Modes::Zero(), speed = Modes::Zero();
  for (int k = 0; k < 800; ++k) advance_bending(model, shape, plate, Vec3::Zero(), Vec3(60, 0, 0), 0.01, bent, speed);
  EXPECT_LT(bent[1], -0.01) << "its halves go outwards, about the rib";
  EXPECT_LT(speed.norm(), 1e-6);

  const LeafPrototype level = almond_leaf("flat", 0.08, 0.05, 0);
  const LeafShape flat = shape_of(level);
  const PlateModel card = plate_of(level, flat, 1, 1, 1.2);
  const LeafBending soft = bending_of(flat, card, 2e-5);
  bent = speed = Modes::Zero();
  for (int k = 0; k < 200; ++k) advance_bending(soft, flat, card, Vec3(0, -3, 0), Vec3::Zero(), 0.01, bent, speed);
  EXPECT_LT(bent.norm(), 1e-3) << "pressure and mass are both even: it is only driven along";
}

/// 40 leaves fall a hand's breadth onto a ground and a box.
LeavesSetup falling(double bending) {
  LeavesSetup setup = many_leaves(40, 0.5, 1, 0);
  setup.bending = bending;
  setup.grounds.push_back({0, 0.5});
  return setup;
}

TEST(LeafBending, What_falls_bends_the_softer_the_more_comes_to_rest_and_sleeps_without_a_vertex_in_the_ground) {
  double most[2] = {0, 0};
  for (const int soft : {0, 1}) {
    const auto solver = solver_of(falling(soft ? 5e-6 : 5e-2));
    ASSERT_EQ(solver->system_shape(0), nullptr) << "a mesh";
    const int vertices = solver->system_mesh(0).vertex_count();
    ASSERT_EQ(vertices, 40 * static_cast<int>(almond_leaf("", 0.08, 0.05, 0.1).positions.size()));
    State state = solver->initial_state();
    FrameReport report;
    for (int f = 0; f < 24 * 8; ++f) {
      report = solver->advance_frame(state);
      ASSERT_TRUE(report.finite);
      std::vector<Vec3> x(at(vertices));
      solver->system_positions(state, 0, x);
      for (const Vec3& p : x) ASSERT_GT(p.y(), 0) << "frame " << f;
      for (const double bent : *state.find("bent")) most[soft] = std::max(most[soft], std::abs(bent));
    }
    EXPECT_EQ(report.own.at("leaves_awake"), 0) << "stiffness " << (soft ? 5e-6 : 5e-2);
    EXPECT_EQ(report.kinetic_energy, 0);
  }
  printf("most bent: stiff %.3f, soft %.3f rad\n", most[0], most[1]);
  EXPECT_GT(most[1], 5 * most[0]);
  EXPECT_GT(most[1], 0.1);
}

TEST(LeafBending, A_leaf_that_lies_on_its_rib_sags_by_its_own_weight) {
  LeavesSetup setup = falling(1e-4);
  setup.mass_variation = 0;
  setup.prototypes = {almond_leaf("oak", 0.08, 0.05, 0.2)};
  setup.leaves.resize(1);
  setup.leaves[0].position = Vec3(0, 0.02, 0);
  setup.leaves[0].orientation = Quat::Identity();
  setup.leaves[0].scale = 1;
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  for (int f = 0; f < 48; ++f) solver->advance_frame(state);
  const auto& bent = *state.find("bent");
  // The weight of the halves, at their centres, turns them about the rib against the fold's stiffness.
  const PlateModel& plate = solver->plate(0);
  const double half_width = 0.025 * std::cos(0.2);
  const double stiffness = setup.bending * plate.area / (half_width * half_width);
  const double sag = plate.mass * k_gravity * plate.panel_arm / stiffness;
  EXPECT_NEAR(bent[1], -sag, 0.05 * sag);
  EXPECT_NEAR(bent[0], 0, 0.001);
}

TEST(LeafBending, One_thread_and_two_and_a_restored_state_have_the_same_bytes) {
  std::vector<Hash128> one, two;
  Bytes saved;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    const auto solver = solver_of(falling(2e-5));
    State state = solver->initial_state();
    for (int f = 0; f < 20; ++f) {
      solver->advance_frame(state);
      (threads == 1 ? one : two).push_back(hash(state));
      if (threads == 1 && f == 9) saved = save(state);
    }
  }
  EXPECT_TRUE(one == two);
  const auto solver = solver_of(falling(2e-5));
  auto state = load_state(saved);
  ASSERT_TRUE(state);
  for (std::size_t f = 10; f < 20; ++f) {
    solver->advance_frame(*state);
    ASSERT_TRUE(hash(*state) == one[f]) << f;
  }
}

}  // namespace
}  // namespace ft

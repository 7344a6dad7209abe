// What the cloth does to its primary: weights, Newton's third law, torques.
#include <gtest/gtest.h>

#include <numeric>

#include "solvers/cloth/cloth_solver.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_side = 0.4;

std::shared_ptr<ScriptedBody> ball(const std::function<Vec3(double)>& path) {
  Surface surface;
  std::vector<Vec3> points;
  make_sphere(0.2, 16, 24, points, surface.triangles);
  surface.part_of_vertex.assign(points.size(), 0);
  surface.parts = {{"ball", -1, 1.0}};
  std::vector<Vec3> bind = points;
  const auto place = [path, points](double time, std::span<Vec3> out) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = points[i] + path(time);
  };
  place(0, bind);
  return std::make_shared<ScriptedBody>(surface, bind, 0, place);
}

ClothSetup sheet_over(std::shared_ptr<const Trajectory> body, double height) {
  ClothSetup setup;
  setup.primary = std::move(body);
  setup.preroll_frames = 0;
  setup.air_density = 0;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(k_side, 12, height);
  setup.garments.push_back(std::move(sheet));
  return setup;
}

std::unique_ptr<Solver> solver_of(const ClothSetup& setup) {
  auto solver = make_cloth_solver(setup);
  EXPECT_TRUE(solver) << (solver ? "" : solver.error().text());
  return std::move(*solver);
}

double mass_of(const ClothSetup& setup) {
  return setup.garments[0].fabric.mass_per_area * k_side * k_side;
}

/// Of the cloth's vertices, by a third of every triangle around them.
Vec3 momentum(const ClothSetup& setup, const State& state) {
  const Mesh& mesh = setup.garments[0].mesh;
  const auto v = as_points(*state.find("v"));
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : triangulate(mesh)) {
    const double area = triangle_area(mesh.positions[at(t[0])], mesh.positions[at(t[1])], mesh.positions[at(t[2])]);
    for (const int i : t) sum += (area * setup.garments[0].fabric.mass_per_area / 3) * v[at(i)];
  }
  return sum;
}

TEST(InteractionForce, Cloth_that_rests_on_a_ball_presses_on_it_with_its_weight) {
  const ClothSetup setup = sheet_over(ball([](double) { return Vec3(0.3, 0, -2); }), 0.205);
  ClothSetup placed = setup;
  for (Vec3& p : placed.garments[0].mesh.positions) p += Vec3(0.3, 0, -2);
  auto solver = solver_of(placed);
  State state = solver->initial_state();
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  constexpr int k_settle = 60, k_mean = 24;
  for (int f = 0; f < k_settle + k_mean; ++f) {
    const FrameReport report = solver->advance_frame(state);
    ASSERT_EQ(report.forces.size(), 1u);
    EXPECT_EQ(report.forces[0].system, "sheet");
    if (f < k_settle) continue;
    EXPECT_DOUBLE_EQ(report.forces[0].contact_share, 1);
    EXPECT_GE(report.forces[0].peak, report.forces[0].mean.force.norm());
    force += report.forces[0].mean.force / k_mean;
    torque += report.forces[0].mean.torque / k_mean;
  }
  const double weight = mass_of(setup) * k_gravity;
  EXPECT_NEAR(force.y(), -weight, 0.02 * weight);
  EXPECT_NEAR(force.x(), 0, 0.02 * weight);
  EXPECT_NEAR(force.z(), 0, 0.02 * weight);
  EXPECT_LT(torque.norm(), 0.02 * weight * 0.2);  // a symmetric sheet, about the ball's middle
}

TEST(InteractionForce, What_the_world_holds_stays_where_it_is_and_is_no_load_on_the_ball) {
  for (const bool to_world : {false, true}) {
    ClothSetup setup = sheet_over(ball([](double t) { return Vec3(3 * t, 0, -2); }), 1);
    ClothPin pin;
    pin.to_world = to_world;
    pin.vertices.resize(setup.garments[0].mesh.positions.size());
    std::iota(pin.vertices.begin(), pin.vertices.end(), 0);
    setup.garments[0].pins.push_back(pin);
    auto solver = solver_of(setup);
    State state = solver->initial_state();
    FrameReport report;
    for (int f = 0; f < 12; ++f) report = solver->advance_frame(state);
    const auto x = as_points(*state.find("x"));
    double away = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      away = std::max(away, (x[i] - setup.garments[0].mesh.positions[i]).norm());
    const double sag = setup.garments[0].fabric.mass_per_area * k_gravity / pin.stiffness;
    if (to_world) {
      EXPECT_LT(away, 2 * sag);
      EXPECT_EQ(report.forces[0].contact_share, 0);
      EXPECT_EQ(report.forces[0].mean.force, Vec3(Vec3::Zero()));
    } else {
      EXPECT_GT(away, 0.5);
      EXPECT_NEAR(report.forces[0].mean.force.y(), -mass_of(setup) * k_gravity, 0.1 * mass_of(setup) * k_gravity);
    }
  }
}

/// Frames in which a ball strikes a sheet from below and carries it; the largest part of a frame's impulse on the ball
/// that the sheet does not lose.
double unbalanced_share(double friction, int newton) {
  ClothSetup setup = sheet_over(ball([](double t) { return Vec3(0, 2 * t - 0.4, 0.5 * t); }), 0);
  setup.bdf2 = false;  // one step's forces make one step's change of momentum
  setup.newton_iterations = newton;
  setup.garments[0].friction = setup.garments[0].self_friction = friction;
  auto solver = solver_of(setup);
  State state = solver->initial_state();
  const double dt = 1 / setup.fps;
  double share = 0, largest = 0;
  for (int f = 0; f < 12; ++f) {
    const Vec3 before = momentum(setup, state);
    const FrameReport report = solver->advance_frame(state);
    const Vec3 given = dt * report.forces[0].mean.force;
    const Vec3 lost = before + dt * mass_of(setup) * setup.gravity - momentum(setup, state);
    largest = std::max(largest, given.norm());
    share = std::max(share, (given - lost).norm() / (mass_of(setup) * k_gravity * dt + given.norm()));
  }
  EXPECT_GT(largest, 2 * mass_of(setup) * k_gravity * dt);
  return share;
}

TEST(InteractionForce, What_the_ball_is_given_is_what_the_cloth_loses) {
  // The rest is what the linear solver leaves in steps in which the ball has no hold on the sheet.
  for (const double friction : {0.0, 0.4}) {
    EXPECT_LT(unbalanced_share(friction, 3), 1e-3) << friction;
    EXPECT_LT(unbalanced_share(friction, 30), 1e-6) << friction;
  }
}

TEST(InteractionForce, Pins_carry_the_weight_of_cloth_that_hangs) {
  ClothSetup setup = sheet_over(ball([](double) { return Vec3(0, 5, 0); }), 0);
  ClothPin pin;
  pin.vertices = {0, 12};
  setup.garments[0].pins.push_back(pin);
  auto solver = solver_of(setup);
  State state = solver->initial_state();
  double force = 0;
  constexpr int k_settle = 96, k_mean = 144;
  for (int f = 0; f < k_settle + k_mean; ++f) {
    const FrameReport report = solver->advance_frame(state);
    if (f >= k_settle) force += report.forces[0].mean.force.y() / k_mean;
  }
  const double weight = mass_of(setup) * k_gravity;
  EXPECT_NEAR(force, -weight, 0.02 * weight);
}

TEST(InteractionForce, Cloth_in_free_fall_does_nothing_to_the_body) {
  auto solver = solver_of(sheet_over(ball([](double) { return Vec3(0, 5, 0); }), 0));
  State state = solver->initial_state();
  const FrameReport report = solver->advance_frame(state);
  ASSERT_EQ(report.forces.size(), 1u);
  EXPECT_EQ(report.forces[0].mean.force, Vec3::Zero());
  EXPECT_EQ(report.forces[0].contact_share, 0);
  EXPECT_EQ(report.forces[0].peak, 0);
}

}  // namespace
}  // namespace ft

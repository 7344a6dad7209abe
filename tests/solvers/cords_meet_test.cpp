// Cords among bodies that push them and do not feel them: grounds, boxes, what moves and what deforms.
#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/parallel.h"
#include "baker/core/shapes.h"
#include "solvers/cords/generators.h"
#include "solvers/lockstep/lockstep_solver.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_radius = 5e-3, k_mass = 0.1;

CordSystem rope_between(const Vec3& from, const Vec3& to, int pieces, double friction = 0.4) {
  RopeMeasures line;
  line.from = from;
  line.to = to;
  line.pieces = pieces;
  line.hold_from = false;
  CordSystem out;
  out.name = "rope";
  out.graph = rope(line);
  out.mass = k_mass;
  out.radius = k_radius;
  out.friction = friction;
  return out;
}

/// A box whose centre goes along a path, and turns about z by an angle.
MetBody moving_box(
    const std::string& name, const Vec3& size, std::function<Vec3(double)> path, bool fixed = false,
    std::function<double(double)> angle = [](double) { return 0.0; }) {
  const TriangleSurface box = box_surface(size);
  Surface surface;
  surface.triangles = box.triangles;
  const auto place = [path, angle](double time, std::span<Vec3> x) {
    const Mat3 turn = Eigen::AngleAxisd(angle(time), Vec3::UnitZ()).toRotationMatrix();
    for (Vec3& p : x) p = turn * p + path(time);
  };
  return {name, std::make_shared<ScriptedBody>(surface, box.positions, 0, place), fixed, {1}};
}

MetBody box_at(const std::string& name, const Vec3& size, const Vec3& centre) {
  return moving_box(
      name, size, [centre](double) { return centre; }, true);
}

MetBody ground() {
  return box_at("ground", Vec3(6, 1, 6), Vec3(0.013, -0.5, 0.021));  // its diagonal is not below the rope's
}

LockstepSetup scene_of(CordSystem rope, std::vector<MetBody> bodies) {
  LockstepSetup setup;
  setup.cords = {std::move(rope)};
  setup.bodies = std::move(bodies);
  setup.preroll_frames = 0;
  return setup;
}

struct Walked {
  std::vector<Vec3> x;  ///< of the points
  State state;
  std::vector<FrameReport> frames;
  int crossings = 0, most_through = 0;
};

Walked walk(const LockstepSetup& setup, int frames) {
  auto solver = make_lockstep_solver(setup);
  EXPECT_TRUE(solver) << solver.error().text();
  Walked out;
  out.state = (*solver)->initial_state();
  for (int f = 0; f < frames; ++f) {
    out.frames.push_back((*solver)->advance_frame(out.state));
    const FrameReport& r = out.frames.back();
    EXPECT_TRUE(r.finite);
    out.crossings += r.crossings_body;
    out.most_through = std::max(out.most_through, r.released_vertices);
  }
  const auto x = as_points(*out.state.find("x"));
  out.x.assign(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(setup.cords[0].graph.points.size()));
  return out;
}

TEST(CordsMeet, A_rope_that_falls_on_a_ground_comes_to_rest_on_it_and_weighs_on_it) {
  const LockstepSetup setup = scene_of(rope_between(Vec3(-0.4, 0.2, 0), Vec3(0.4, 0.35, 0.1), 24), {ground()});
  const Walked end = walk(setup, 24 * 3);
  EXPECT_EQ(end.crossings, 0);
  EXPECT_EQ(end.most_through, 0);
  for (const Vec3& p : end.x) {
    EXPECT_GT(p.y(), 0);
    EXPECT_LT(p.y(), 2 * k_radius);  // contact begins there
  }
  EXPECT_LT(end.frames.back().kinetic_energy, 1e-6 * k_mass * k_gravity * 0.3);
  const InteractionForce& on_ground = end.frames.back().forces.at(0);
  EXPECT_EQ(on_ground.primary, "ground");
  EXPECT_NEAR(on_ground.mean.force.y(), -k_mass * k_gravity, 0.01 * k_mass * k_gravity);
  EXPECT_DOUBLE_EQ(on_ground.contact_share, 1);
}

TEST(CordsMeet, A_rope_that_falls_far_hardly_bounces) {
  const double height = 1.75;
  const LockstepSetup setup =
      scene_of(rope_between(Vec3(-0.4, height, 0), Vec3(0.4, height + 0.02, 0.1), 24), {ground()});
  auto solver = make_lockstep_solver(setup);
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  bool touched = false;
  double impulse = 0, highest = 0;
  for (int f = 0; f < 24 * 2; ++f) {
    const FrameReport r = (*solver)->advance_frame(state);
    EXPECT_EQ(r.crossings_body, 0);
    touched = touched || r.forces[0].contact_share > 0;
    impulse -= r.forces[0].mean.force.y() / 24;
    const auto x = as_points(*state.find("x"));
    if (touched && f > 18)
      for (const Vec3& p : x) highest = std::max(highest, p.y());
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(highest, 0.05 * height);
  EXPECT_NEAR(impulse, 2 * k_mass * k_gravity, 0.05 * 2 * k_mass * k_gravity) << "all that gravity gave it in 2 s";
}

/// How far a rope goes down an inclined plane in a second; it lies along the slope or across it.
double way_down(double tangent, double friction, bool across) {
  LockstepSetup setup =
      scene_of(across ? rope_between(Vec3(0, 1.97 * k_radius, -0.3), Vec3(0, 1.97 * k_radius, 0.3), 12, friction)
                      : rope_between(Vec3(-0.3, 1.97 * k_radius, 0), Vec3(0.3, 1.97 * k_radius, 0), 12, friction),
               {ground()});
  const double angle = std::atan(tangent);
  setup.gravity = k_gravity * Vec3(std::sin(angle), -std::cos(angle), 0);
  setup.air_density = 0;
  const Walked end = walk(setup, 24);
  EXPECT_EQ(end.crossings, 0);
  double mean = 0;
  for (std::size_t i = 0; i < end.x.size(); ++i)
    mean += (end.x[i].x() - setup.cords[0].graph.points[i].x()) / static_cast<double>(end.x.size());
  return mean;
}

TEST(CordsMeet, On_a_slope_a_rope_sticks_below_its_friction_and_slides_above_as_coulomb_says) {
  for (const bool across : {false, true}) {
    EXPECT_LT(std::abs(way_down(0.36, 0.4, across)), 2e-3) << across;  // it creeps by less than 1 mm/s
    const double angle = std::atan(0.6), slides = 0.5 * k_gravity * (std::sin(angle) - 0.4 * std::cos(angle));
    EXPECT_NEAR(way_down(0.6, 0.4, across), slides, 0.02 * slides) << across;
    EXPECT_NEAR(way_down(0.6, 0, across), 0.5 * k_gravity * std::sin(angle), 0.01 * k_gravity) << across;
  }
}

TEST(CordsMeet, A_rope_thrown_over_a_box_hangs_on_both_sides_of_it) {
  const LockstepSetup setup = scene_of(rope_between(Vec3(-0.48, 0.6, 0.01), Vec3(0.52, 0.6, 0.03), 50, 0.6),
                                       {box_at("box", Vec3(0.2, 0.5, 0.3), Vec3(0, 0.25, 0)), ground()});
  const Walked end = walk(setup, 24 * 4);
  EXPECT_EQ(end.crossings, 0);
  EXPECT_EQ(end.most_through, 0);
  EXPECT_NEAR(end.x[24].y(), 0.5 + 1.5 * k_radius, k_radius) << "on the box";
  for (const std::size_t tip : {std::size_t{0}, end.x.size() - 1}) {
    EXPECT_LT(end.x[tip].y(), 0.25) << "hangs down";
    EXPECT_GT(std::abs(end.x[tip].x()), 0.1) << "beside the box";
  }
  EXPECT_LT(end.x.front().x() * end.x.back().x(), 0);
  const auto& forces = end.frames.back().forces;
  ASSERT_EQ(forces.size(), 2u);
  EXPECT_NEAR(forces[0].mean.force.y(), -k_mass * k_gravity, 0.02 * k_mass * k_gravity);
  EXPECT_EQ(forces[1].mean.force, Vec3(Vec3::Zero())) << "the ground";
}

TEST(CordsMeet, What_is_fast_and_thin_takes_a_rope_along_and_never_passes_it) {
  for (const double speed : {2.0, 15.0, 40.0}) {
    LockstepSetup setup = scene_of(rope_between(Vec3(0, -0.3, 0.002), Vec3(0, 0.3, -0.003), 24), {});
    setup.gravity.setZero();
    setup.bodies.push_back(
        moving_box("plate", Vec3(0.01, 1, 1), [speed](double t) { return Vec3(-0.1 + speed * t, 0, 0); }));
    const Walked end = walk(setup, 6);
    EXPECT_EQ(end.crossings, 0) << speed;
    EXPECT_EQ(end.most_through, 0) << speed;
    const double front = -0.1 + speed * 6 / 24 + 0.005;
    for (const Vec3& p : end.x) EXPECT_GT(p.x(), front) << speed;
  }
}

TEST(CordsMeet, A_blade_that_turns_through_a_hanging_rope_pushes_it_aside) {
  CordSystem hanging = rope_between(Vec3(0, 0.5, 0), Vec3(0, -0.2, 0), 28);
  hanging.graph.held = {0};
  LockstepSetup setup = scene_of(hanging, {});
  setup.bodies.push_back(moving_box(
      "blade", Vec3(0.6, 0.02, 0.2), [](double) { return Vec3(-0.2, 0, 0); }, false,
      [](double t) { return -1.2 + 20 * t; }));
  const Walked end = walk(setup, 24);
  EXPECT_EQ(end.crossings, 0);
  EXPECT_EQ(end.most_through, 0);
}

TEST(CordsMeet, A_rope_on_a_platform_goes_along_with_it) {
  LockstepSetup setup = scene_of(rope_between(Vec3(-0.2, 1.97 * k_radius, 0), Vec3(0.2, 1.97 * k_radius, 0), 12), {});
  setup.bodies.push_back(moving_box("platform", Vec3(2, 0.2, 2), [](double t) {
    return Vec3(0.5 * t * t, -0.1 + 0.3 * t, 0);  // 1 m/s2: friction holds up to 3.9
  }));
  const Walked end = walk(setup, 24);
  EXPECT_EQ(end.crossings, 0);
  for (std::size_t i = 0; i < end.x.size(); ++i) {
    EXPECT_NEAR(end.x[i].x(), setup.cords[0].graph.points[i].x() + 0.5, 5e-3);
    EXPECT_NEAR(end.x[i].y(), 0.3 + 1.5 * k_radius, k_radius);
  }
  EXPECT_NEAR(end.frames.back().forces[0].mean.force.x(), -k_mass, 0.05 * k_mass);
}

TEST(CordsMeet, What_is_squeezed_is_let_through_and_told_and_comes_free_again) {
  LockstepSetup setup = scene_of(rope_between(Vec3(-0.2, 0.05, 0), Vec3(0.2, 0.05, 0), 12), {ground()});
  // It comes down to 1 mm above the ground, where nothing that is 10 mm thick has room, and goes up again.
  setup.bodies.push_back(moving_box("press", Vec3(0.2, 0.2, 0.2), [](double t) {
    const double down = std::clamp(2 * t, 0.0, 1.0) - std::clamp(2 * (t - 0.6), 0.0, 1.0);
    return Vec3(0, 0.1 + 0.3 - 0.3 * down - 2e-4 * down, 0);
  }));
  const Walked end = walk(setup, 48);
  EXPECT_GT(end.most_through, 0);
  bool told = false;
  for (const FrameReport& r : end.frames)
    for (const Incident& i : r.incidents)
      told = told || (i.kind == Incident::Kind::k_released && i.text.find("\"press\"") != std::string::npos &&
                      i.text.find("\"ground\"") == std::string::npos);
  EXPECT_TRUE(told);
  EXPECT_EQ(end.frames.back().released_vertices, 0);
  EXPECT_EQ(end.frames.back().crossings_body, 0);
  for (const Vec3& p : end.x) EXPECT_GT(p.y(), 0) << "the ground was met all the time";
}

TEST(CordsMeet, Cords_that_start_inside_a_body_pass_it_until_they_are_out) {
  LockstepSetup setup = scene_of(rope_between(Vec3(-0.3, 0.3, 0), Vec3(0.3, 0.3, 0), 24),
                                 {box_at("box", Vec3(0.2, 0.1, 0.2), Vec3(0, 0.32, 0)), ground()});
  const Walked end = walk(setup, 72);
  EXPECT_GT(end.frames.front().released_vertices, 0);
  ASSERT_FALSE(end.frames.front().incidents.empty());
  EXPECT_NE(end.frames.front().incidents.back().text.find("\"box\", in which they started"), std::string::npos)
      << end.frames.front().incidents.back().text;
  EXPECT_EQ(end.frames.back().released_vertices, 0);
  EXPECT_EQ(end.frames.back().crossings_body, 0);
  for (const Vec3& p : end.x) EXPECT_LT(p.y(), 2 * k_radius) << "it lies on the ground";
}

TEST(CordsMeet, A_rope_that_does_not_meet_a_body_falls_through_it) {
  LockstepSetup setup = scene_of(rope_between(Vec3(-0.3, 0.5, 0), Vec3(0.3, 0.5, 0), 12),
                                 {box_at("box", Vec3(0.2, 0.1, 0.2), Vec3(0, 0.3, 0)), ground()});
  setup.bodies[0].met_by = {0};
  const Walked end = walk(setup, 72);
  EXPECT_EQ(end.crossings, 0) << "of what it meets";
  ASSERT_EQ(end.frames.back().forces.size(), 1u);
  EXPECT_EQ(end.frames.back().forces[0].primary, "ground");
  for (const Vec3& p : end.x) EXPECT_LT(p.y(), 2 * k_radius);
}

TEST(CordsMeet, The_same_bytes_for_any_number_of_threads_and_from_any_checkpoint) {
  LockstepSetup setup = scene_of(rope_between(Vec3(-0.48, 0.52, 0.01), Vec3(0.52, 0.52, 0.03), 30),
                                 {box_at("box", Vec3(0.2, 0.1, 0.3), Vec3(0, 0.45, 0)), ground()});
  setup.bodies.push_back(moving_box("hand", Vec3(0.1, 0.1, 0.1), [](double t) { return Vec3(0.6 - 2 * t, 0.4, 0); }));
  Hash128 one;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    auto solver = make_lockstep_solver(setup);
    ASSERT_TRUE(solver);
    State state = (*solver)->initial_state();
    for (int f = 0; f < 12; ++f) {
      (*solver)->advance_frame(state);
      if (threads == 1) continue;
      auto again = load_state(save(state));
      ASSERT_TRUE(again);
      state = std::move(*again);
      solver = make_lockstep_solver(setup);  // nothing that it remembers may decide
    }
    if (threads == 1)
      one = hash(state);
    else
      EXPECT_EQ(one, hash(state));
  }
}

}  // namespace
}  // namespace ft

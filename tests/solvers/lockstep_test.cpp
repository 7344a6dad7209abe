// Cords and a rigid prop in lock step, against closed forms and balances.
#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/parallel.h"
#include "tests/support/ball_and_net.h"

namespace ft {
namespace {

using namespace test;

std::unique_ptr<Solver> made(LockstepSetup setup) {
  auto solver = make_lockstep_solver(std::move(setup));
  EXPECT_TRUE(solver) << solver.error().text();
  return std::move(*solver);
}

FrameReport advance(Solver& solver, State& state, int frames) {
  FrameReport last;
  for (int f = 0; f < frames; ++f) last = solver.advance_frame(state);
  return last;
}

TEST(Lockstep, A_released_ball_flies_ballistically_and_keeps_its_spin) {
  LockstepSetup setup = ball_and_net(true);
  setup.prop = flying_ball(Vec3(0, 1, 2), Vec3(1.5, 4, -0.5), Vec3(3, -4, 5), true);  // past the net
  setup.prop->release = 0.1;
  const RigidMass mass = setup.prop->mass;
  const auto track = setup.prop->track;
  const auto solver = made(setup);
  State state = solver->initial_state();
  advance(*solver, state, 5 + 60);
  ASSERT_NEAR(state.time, 1.0, 1e-12);
  const RigidMotion m = motion_of_prop(state, mass);
  EXPECT_LT((m.pose.position - track(1).pose.position).norm(), 1e-9);
  EXPECT_LT((m.velocity - track(1).velocity).norm(), 1e-9);
  EXPECT_NEAR(m.spin.norm(), std::sqrt(50.0), 0.01);  // second order in the step
  EXPECT_LT(m.spin.normalized().cross(Vec3(3, -4, 5).normalized()).norm(), 1e-6);
}

TEST(Lockstep, The_frame_of_a_body_has_its_mass_and_inertia) {
  RigidMass mass{2.5, Vec3(0.02, 0.05, 0.06).asDiagonal()};
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  mass.inertia = turn * mass.inertia * turn.transpose();
  const Equimomental frame = equimomental(mass);
  Vec3 centre = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  for (const Vec3& p : frame.node) {
    centre += p;
    inertia += mass.mass / 4 * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
  }
  EXPECT_LT(centre.norm(), 1e-14);
  EXPECT_LT((inertia - mass.inertia).norm(), 1e-14);
  const Vec3 point(0.1, -0.2, 0.3);
  const auto w = frame.weights(point);
  EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-14);
  EXPECT_LT((w[0] * frame.node[0] + w[1] * frame.node[1] + w[2] * frame.node[2] + w[3] * frame.node[3] - point).norm(),
            1e-14);
  RigidPose pose;
  pose.position = Vec3(1, 2, 3);
  pose.rotation = Quat(Eigen::AngleAxisd(2.1, Vec3(3, -1, 1).normalized()));
  const auto placed = frame.place(pose);
  EXPECT_LT((frame.pose(placed).rotation.toRotationMatrix() - pose.rotation.toRotationMatrix()).norm(), 1e-13);
}

TEST(Lockstep, A_filled_and_a_hollow_box_weigh_what_formulas_say) {
  const Vec3 size(0.2, 0.3, 0.5);
  const TriangleSurface box = box_surface(size);
  const BodyMass filled = filled_mass(box.positions, box.triangles, 3);
  EXPECT_NEAR(filled.mass.inertia(0, 0), 3.0 / 12 * (0.09 + 0.25), 1e-12);
  EXPECT_NEAR(filled.mass.inertia(2, 2), 3.0 / 12 * (0.04 + 0.09), 1e-12);
  EXPECT_LT(filled.centre.norm(), 1e-14);
  const TriangleSurface ball = sphere_surface(0.121, 5);
  EXPECT_NEAR(hollow_mass(ball.positions, ball.triangles, 0.68).mass.inertia(1, 1), 0.00664, 1e-5);
}

/// What the discrete momentum balance keeps, summed over 0.1 s. Implicit Euler: p grows by h F in each step, halved
/// ones too. BDF2: p - p_before / 3 grows by 2/3 h F in a step as long as the last.
TEST(Lockstep, Momentum_of_ball_net_and_rim_is_closed_in_two_way_contact_slow) {
  for (const bool bdf2 : {false, true}) {
    LockstepSetup setup = ball_and_net(true);
    setup.bdf2 = bdf2;
    setup.air_density = 0;
    const double h = setup.longest_step;
    setup.fps = 1 / h;  // one step a frame
    setup.preroll_frames = 1;
    const auto track = setup.prop->track;
    setup.prop->track = [=](double t) { return track(t + 0.33); };  // just before it touches
    const RigidMass mass = setup.prop->mass;
    const auto solver = made(setup);
    State state = solver->initial_state();
    advance(*solver, state, 4);
    const std::size_t points = setup.cords[0].graph.points.size();
    const std::vector<double> masses = lumped_masses(setup.cords[0].graph, k_net_mass);
    const auto momentum = [&](const State& s) {
      const auto v = as_points(*s.find("v"));
      Vec3 p = Vec3::Zero();
      for (std::size_t i = 0; i < points; ++i) p += masses[i] * v[i];
      for (std::size_t k = 0; k < 4; ++k) p += mass.mass / 4 * v[points + k];
      return p;
    };
    const auto held = [](const State& s) { return as_points(*s.find("hold_impulse"))[0]; };
    const Vec3 weight = (k_ball_mass + k_net_mass) * Vec3(0, -k_gravity, 0);
    const double of_last = bdf2 ? 1.0 / 3 : 0;
    std::array<Vec3, 3> p{momentum(state), momentum(state), momentum(state)};  // the last three, latest last
    Vec3 missing = Vec3::Zero();
    double force = 0, most = 0;
    int alike = 0, balanced = 0;
    const int steps = static_cast<int>(std::lround(0.1 / h));
    for (int i = 0; i < steps; ++i) {
      const Vec3 held_before = held(state);
      const FrameReport r = solver->advance_frame(state);
      force = std::max(force, r.forces[0].mean.force.norm());
      p = {p[1], p[2], momentum(state)};
      alike = r.substeps > 1 ? 0 : alike + 1;
      if (bdf2 && alike < 3) continue;
      const Vec3 gained = (p[2] - p[1] - of_last * (p[1] - p[0])) / (1 - of_last);
      missing += gained - (held(state) - held_before + h * weight);
      most = std::max(most, missing.norm());
      ++balanced;
    }
    EXPECT_GT(force, 20);  // it did touch
    EXPECT_GT(balanced, 0.8 * steps);
    EXPECT_LT(most, 1e-8) << (bdf2 ? "BDF2" : "implicit Euler");
  }
}

TEST(Lockstep, A_hanging_rope_pulls_with_its_weight_and_sags_as_a_catenary) {
  CordGraph graph;
  const int pieces = 120;
  const double span = 1, length = 1.2;
  for (int i = 0; i <= pieces; ++i) {  // as a V
    const double s = std::abs(2.0 * i / pieces - 1);
    graph.points.emplace_back(span * i / pieces, -(1 - s) * std::sqrt(length * length - span * span) / 2, 0);
    if (i > 0) graph.cords.push_back({i - 1, i});
  }
  graph.held = {0, pieces};
  join_strands(graph);
  LockstepSetup setup;
  CordSystem rope;
  rope.name = "rope";
  rope.graph = graph;
  rope.mass = 0.6;
  rope.stretch = 1e5;
  rope.damping = 1e-2;
  rope.hold_stiffness = 1e6;
  setup.cords = {rope};
  setup.preroll_frames = 0;
  setup.air_density = 50;  // thick, so that it comes to rest
  setup.longest_step = 1.0 / 240;
  setup.bdf2 = false;
  const auto solver = made(setup);
  State state = solver->initial_state();
  advance(*solver, state, 24 * 6);
  const auto x = as_points(*state.find("x"));
  EXPECT_NEAR(-x[pieces / 2].y(), 0.29234, 0.005 * 0.29234);
  const Vec3 before = as_points(*state.find("hold_impulse"))[0];
  advance(*solver, state, 24);
  const Vec3 force = as_points(*state.find("hold_impulse"))[0] - before;  // of a second
  EXPECT_NEAR(force.y(), 0.6 * k_gravity, 1e-3 * 0.6 * k_gravity);
}

TEST(Lockstep, A_ball_on_contact_is_let_go_where_it_touches_and_not_before) {
  LockstepSetup setup = ball_and_net(true);
  setup.prop->release = std::numeric_limits<double>::infinity();
  setup.prop->release_on_contact = true;
  const auto track = setup.prop->track;
  const RigidMass mass = setup.prop->mass;
  const auto solver = made(setup);
  State state = solver->initial_state();
  bool free_before = false;
  for (int f = 0; f < 5 + 24; ++f) {
    const FrameReport r = solver->advance_frame(state);
    const bool is_free = state.find("free")->front() != 0;
    if (!is_free) {
      EXPECT_EQ(r.forces[0].mean.force.norm(), 0) << "touched before it was let go, frame " << r.frame;
      EXPECT_LT((motion_of_prop(state, mass).pose.position - track(state.time).pose.position).norm(), 1e-9);
    }
    EXPECT_TRUE(is_free || !free_before);
    free_before = is_free;
  }
  EXPECT_TRUE(free_before);
  EXPECT_GT((motion_of_prop(state, mass).pose.position - track(state.time).pose.position).norm(), 1e-3);
}

/// A taut wire between two walls, and a ball that is driven onto it from above, until its middle is at this height [m].
LockstepSetup ball_on_wire(double lowest) {
  LockstepSetup setup;
  CordSystem wire;
  wire.name = "wire";
  RopeMeasures measures;
  measures.from = Vec3(-0.2, 0, 0);
  measures.to = Vec3(0.2, 0, 0);
  measures.pieces = 12;
  measures.hold_to = true;
  wire.graph = rope(measures);
  wire.hold_stiffness = 1e6;
  setup.cords = {wire};
  setup.prop = flying_ball(Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), false);
  setup.prop->track = [lowest](double t) {
    RigidMotion m;
    m.pose.position = Vec3(0.003, std::max(lowest, 0.2 - 2 * std::max(0.0, t)), 0.002);
    return m;
  };
  setup.fps = 60;
  setup.preroll_frames = 1;
  return setup;
}

TEST(Lockstep, What_is_driven_goes_its_way_and_cords_that_cannot_yield_are_let_through) {
  for (const double lowest : {0.1, -0.4}) {
    const LockstepSetup setup = ball_on_wire(lowest);
    const auto solver = made(setup);
    State state = solver->initial_state();
    int most_through = 0;
    bool told = false;
    for (int f = 0; f < 1 + 20; ++f) {
      const FrameReport r = solver->advance_frame(state);
      EXPECT_TRUE(r.finite);
      most_through = std::max(most_through, r.released_vertices);
      for (const Incident& i : r.incidents) told = told || i.kind == Incident::Kind::k_released;
      const auto x = as_points(*state.find("x")).last<4>();
      EXPECT_LT((0.25 * (x[0] + x[1] + x[2] + x[3]) - setup.prop->track(state.time).pose.position).norm(), 2e-4);
    }
    EXPECT_EQ(most_through > 0, lowest < 0) << lowest;  // a dent it gives way to, a wire of three times its length not
    EXPECT_EQ(told, most_through > 0);
  }
}

TEST(Lockstep, The_same_bytes_for_any_number_of_threads_and_from_any_checkpoint_slow) {
  LockstepSetup setup = ball_and_net(true);
  const auto track = setup.prop->track;
  setup.prop->track = [=](double t) { return track(t + 0.33); };
  Hash128 one;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    const auto solver = made(setup);
    State state = solver->initial_state();
    for (int f = 0; f < 12; ++f) {
      advance(*solver, state, 1);
      if (threads == 1) continue;
      auto again = load_state(save(state));
      ASSERT_TRUE(again);
      state = std::move(*again);
    }
    if (threads == 1)
      one = hash(state);
    else
      EXPECT_EQ(one, hash(state)) << threads << " threads";
  }
}

TEST(Lockstep, Steps_that_do_not_settle_are_halved_and_then_said) {
  RopeMeasures line;
  line.to = Vec3(0.3, 0, 0);
  line.pieces = 6;
  line.hold_from = true;
  CordSystem swing;
  swing.name = "swing";
  swing.graph = rope(line);
  LockstepSetup setup;
  setup.cords = {swing};
  setup.preroll_frames = 0;
  setup.longest_step = 1.0 / 240;  // ten a frame
  const auto usual = made(setup);
  State of_usual = usual->initial_state();
  for (int f = 0; f < 3; ++f) {
    const FrameReport r = usual->advance_frame(of_usual);
    EXPECT_EQ(r.substeps, 10);
    EXPECT_TRUE(r.incidents.empty());
  }

  setup.settled = 0;  // what no step can do
  const auto never = made(setup);
  setup.settled = LockstepSetup().settled;
  setup.min_substeps = 80;
  const auto shorter = made(setup);
  State of_never = never->initial_state(), of_shorter = shorter->initial_state();
  for (int f = 0; f < 3; ++f) {
    const FrameReport r = never->advance_frame(of_never);
    EXPECT_EQ(r.substeps, 10 * (1 + 2 + 4 + 8));
    ASSERT_EQ(r.incidents.size(), 1u);
    EXPECT_EQ(r.incidents[0].kind, Incident::Kind::k_unsettled);
    EXPECT_LT(r.incidents[0].depth, 1e-8);
    EXPECT_EQ(shorter->advance_frame(of_shorter).substeps, 80);
  }
  const auto x = as_points(*of_never.find("x")), y = as_points(*of_shorter.find("x"));
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((x[i] - y[i]).norm(), 1e-7) << i;
}

TEST(Lockstep, A_two_way_prop_without_mass_and_cords_without_length_are_refused) {
  LockstepSetup setup = ball_and_net(true);
  setup.prop->mass.mass = 0;
  auto refused = make_lockstep_solver(setup);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("needs a mass"), std::string::npos) << refused.error().text();
  setup = ball_and_net(true);
  setup.cords[0].graph.points[1] = setup.cords[0].graph.points[0];
  setup.cords[0].graph.cords.push_back({0, 1});
  refused = make_lockstep_solver(setup);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("has no length"), std::string::npos) << refused.error().text();
  setup = ball_and_net(true);
  setup.prop->release = -10;
  refused = make_lockstep_solver(setup);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("before the bake"), std::string::npos) << refused.error().text();
}

}  // namespace
}  // namespace ft

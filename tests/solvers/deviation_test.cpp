// Deviation dynamics against closed forms: what is exact there is exact here.
#include "deviation_scene.h"

namespace ft {
namespace {

using namespace test;

TEST(Deviation, Without_a_force_the_clip_comes_out_to_the_last_bit) {
  RigidMotion release;
  release.velocity = Vec3(1.1, 3.7, -0.3), release.spin = Vec3(0.3, 1, 5);
  const RigidMass mass{2, Vec3(0.1, 0.2, 0.15).asDiagonal()};
  const YieldingBody body = flying_body(release, mass, Vec3(0, -k_gravity, 0));
  StandInSpec elsewhere = field(5);
  elsewhere.position = Vec3(0, 5e3, 0);
  for (const Comeback comeback : {Comeback::k_free, Comeback::k_spring, Comeback::k_window, Comeback::k_hold}) {
    DeviationSettings settings;
    settings.comeback = comeback;
    const Deviation d = deviation(body, stand_ins({elsewhere}), settings);
    DeviationState state = d.start(0);
    for (int frame = 1; frame <= 24; ++frame) {
      const DeviationStep step = advance(d, state, frame / 24.0);
      const RigidMotion clip = body.motion(frame / 24.0);
      EXPECT_EQ(step.motion.pose.position, clip.pose.position);
      EXPECT_EQ(step.motion.pose.rotation.coeffs(), clip.pose.rotation.coeffs());
      EXPECT_EQ(step.motion.velocity, clip.velocity);
      EXPECT_EQ(step.motion.spin, clip.spin);
      EXPECT_EQ(step.wrench.force, Vec3::Zero().eval());
      EXPECT_EQ(step.work, 0);
    }
    EXPECT_EQ(d.untouched(state), std::vector<std::string>{"net"});
  }
}

TEST(Deviation, A_constant_force_moves_by_half_F_over_M_t_squared) {
  const Vec3 force(3, -1, 2), torque(0, 0, 0.02);
  std::vector<std::unique_ptr<StandIn>> acting;
  acting.push_back(std::make_unique<ConstantForce>(force, torque));
  const Deviation d = deviation(still_body(ball_mass()), std::move(acting));
  DeviationState state = d.start(0);
  const DeviationStep step = advance(d, state, 0.7);
  const double inertia = ball_mass().inertia(0, 0), t = 0.7;
  EXPECT_LT((step.motion.pose.position - 0.5 * t * t / 0.68 * force).norm(), 1e-12);
  EXPECT_LT((step.motion.velocity - t / 0.68 * force).norm(), 1e-12);
  EXPECT_LT((step.wrench.force - force).norm(), 1e-12);
  EXPECT_LT((step.motion.spin - t / inertia * torque).norm(), 1e-11);
  EXPECT_LT(step.motion.pose.rotation.angularDistance(rotation_by(0.5 * t * t / inertia * torque)), 1e-11);
  EXPECT_NEAR(step.work,
              0.5 * 0.68 * step.motion.velocity.squaredNorm() + 0.5 * inertia * step.motion.spin.squaredNorm(), 1e-12);
}

TEST(Deviation, Damping_alone_slows_a_ball_exponentially) {
  RigidMotion release;
  release.velocity = Vec3(5, 0, 0), release.spin = Vec3(0, 0, -12);
  StandInSpec net = field(4);
  net.damping_spin = 0.03;
  for (const double step : {1.0 / 240, 1.0 / 1000}) {
    DeviationSettings settings;
    settings.step = step;
    settings.gravity = Vec3::Zero();
    const Deviation d = deviation(flying_body(release, ball_mass(), Vec3::Zero()), stand_ins({net}), settings);
    DeviationState state = d.start(0);
    const RigidMotion m = advance(d, state, 0.25).motion;
    EXPECT_NEAR(m.velocity.x(), 5 * std::exp(-4 * 0.25 / 0.68), 1e-12);
    EXPECT_NEAR(m.velocity.x(), 1.14895, 5e-6);  // as the figure is printed
    EXPECT_NEAR(m.pose.position.x(), 5 * 0.68 / 4 * (1 - std::exp(-4 * 0.25 / 0.68)), 1e-12);
    const double rate = 0.03 / ball_mass().inertia(0, 0);
    EXPECT_NEAR(m.spin.z(), -12 * std::exp(-rate * 0.25), 1e-11);
    EXPECT_LT(m.pose.rotation.angularDistance(rotation_by(Vec3(0, 0, -12 / rate * (1 - std::exp(-rate * 0.25))))),
              1e-11);
  }
}

TEST(Deviation, A_ballistic_clip_and_its_deviation_are_the_direct_simulation) {
  RigidMotion release;
  release.pose.position = Vec3(0, 3, 0);
  release.velocity = Vec3(3, 4, -1), release.spin = Vec3(0, 8, 0);
  const Vec3 gravity(0, -k_gravity, 0);
  const double c = 3.9, m = 0.68, rate = c / m;
  const Deviation d = deviation(flying_body(release, ball_mass(), gravity), stand_ins({field(c)}));
  DeviationState state = d.start(0);
  for (const double t : {0.1, 0.35, 0.8}) {
    const RigidMotion motion = advance(d, state, t).motion;
    const Vec3 end = gravity / rate, decaying = (release.velocity - end) * std::exp(-rate * t);  // terminal velocity
    EXPECT_LT((motion.velocity - end - decaying).norm(), 1e-12);
    const Vec3 place = release.pose.position + t * end + (release.velocity - end) * (1 - std::exp(-rate * t)) / rate;
    EXPECT_LT((motion.pose.position - place).norm(), 1e-12);
  }
}

TEST(Deviation, The_spring_back_lets_a_constant_force_move_by_F_over_K) {
  std::vector<std::unique_ptr<StandIn>> acting;
  acting.push_back(std::make_unique<ConstantForce>(Vec3(0, 0, 6), Vec3::Zero()));
  DeviationSettings settings;
  settings.comeback = Comeback::k_spring;
  const Deviation d = deviation(still_body(ball_mass()), std::move(acting), settings);
  DeviationState state = d.start(0);
  advance(d, state, 1);
  const double w = settings.omega;  // critically damped
  EXPECT_NEAR(state.offset.position.z(), 6 / (0.68 * w * w) * (1 - (1 + w) * std::exp(-w)), 1e-12);
  advance(d, state, 10);
  EXPECT_NEAR(state.offset.position.z(), 6 / (0.68 * w * w), 1e-12);
}

TEST(Deviation, Comes_back_or_stays_as_it_is_told) {
  const auto after = [](Comeback comeback, double time) {
    StandInSpec gate;
    gate.until = 0.2;
    std::vector<std::unique_ptr<StandIn>> acting;
    acting.push_back(std::make_unique<ConstantForce>(Vec3(2, 0, 0), Vec3(0, 0.004, 0), gate));
    DeviationSettings settings;
    settings.comeback = comeback;
    const Deviation d = deviation(still_body(ball_mass()), std::move(acting), settings);
    DeviationState state = d.start(0);
    advance(d, state, time);
    return Vec3(state.offset.position.x(), rotation_vector(state.offset.rotation).y(), state.velocity.x());
  };
  const double pushed = 0.5 * 2 / 0.68 * 0.04, speed = 2 / 0.68 * 0.2, turn = 0.004 / ball_mass().inertia(0, 0);
  const Vec3 freely = after(Comeback::k_free, 1.2);
  EXPECT_NEAR(freely.x(), pushed + speed, 1e-12);
  EXPECT_NEAR(freely.y(), 0.5 * turn * 0.04 + turn * 0.2, 1e-11);
  // All of the impulse's speed runs out at the rate 2 omega.
  const Vec3 held = after(Comeback::k_hold, 9);
  EXPECT_NEAR(held.x(), pushed + speed / (4 * std::numbers::pi), 1e-12);
  EXPECT_LT(std::abs(held.z()), 1e-12);
  EXPECT_NEAR(after(Comeback::k_window, 0.2).x(), pushed, 1e-12);  // not before it is let go
  for (const Comeback comeback : {Comeback::k_spring, Comeback::k_window}) {
    EXPECT_LT(std::abs(after(comeback, 9).x()), 1e-9);
    EXPECT_LT(std::abs(after(comeback, 9).y()), 1e-9);
  }
}

TEST(Deviation, At_the_edges_of_a_gate_place_and_velocity_go_on) {
  StandInSpec gate;
  gate.from = 0.1003, gate.until = 0.2117;
  std::vector<std::unique_ptr<StandIn>> acting;
  acting.push_back(std::make_unique<ConstantForce>(Vec3(2, 0, 0), Vec3::Zero(), gate));
  const Deviation d = deviation(still_body(ball_mass()), std::move(acting));
  DeviationState state = d.start(0);
  advance(d, state, 0.1003);
  EXPECT_TRUE(state.is_zero());
  DeviationState before = state;
  constexpr double k_dt = 1e-4, k_acceleration = 2 / 0.68;
  for (int i = 1; i <= 1300; ++i) {
    advance(d, state, 0.1003 + k_dt * i);
    EXPECT_LE((state.velocity - before.velocity).norm(), k_acceleration * k_dt * (1 + 1e-9));
    EXPECT_LE((state.offset.position - before.offset.position - k_dt * before.velocity).norm(),
              k_acceleration * k_dt * k_dt * (1 + 1e-6));
    before = state;
  }
  EXPECT_NEAR(state.velocity.x(), k_acceleration * (0.2117 - 0.1003), 1e-12);  // the gate is met exactly
}

TEST(Deviation, Stays_within_the_limits_of_displacement_acceleration_and_axes) {
  const auto make = [](const DeviationSettings& settings) {
    std::vector<std::unique_ptr<StandIn>> acting;
    acting.push_back(std::make_unique<ConstantForce>(Vec3(3, 4, 0), Vec3(0.01, 0, 0.02)));
    return deviation(still_body(ball_mass()), std::move(acting), settings);
  };
  DeviationSettings near;
  near.max_displacement = 0.05;
  Deviation d = make(near);
  DeviationState state = d.start(0);
  for (int i = 1; i < 50; ++i) {
    advance(d, state, 0.02 * i);
    EXPECT_LE(state.offset.position.norm(), 0.05 * (1 + 1e-12));
  }
  EXPECT_LT(state.velocity.norm(), 0.05);
  DeviationSettings gentle;
  gentle.max_acceleration = 2;
  d = make(gentle), state = d.start(0);
  advance(d, state, 0.5);
  EXPECT_NEAR(state.velocity.norm(), 1, 1e-12);
  DeviationSettings upright;
  upright.move_axes = Vec3(0, 1, 0), upright.turn_axes = Vec3(0, 0, 1);
  d = make(upright), state = d.start(0);
  advance(d, state, 0.5);
  EXPECT_EQ(state.velocity.x(), 0);
  EXPECT_NEAR(state.velocity.y(), 0.5 * 4 / 0.68, 1e-12);
  EXPECT_EQ(state.angular_momentum.x(), 0);
  EXPECT_NEAR(state.angular_momentum.z(), 0.01, 1e-12);
}

TEST(Deviation, Work_of_damping_is_what_the_ball_loses) {
  RigidMotion release;
  release.velocity = Vec3(5, 2, 0), release.spin = Vec3(3, 0, -12);
  StandInSpec net = field(4);
  net.damping_quadratic = 0.5, net.damping_spin = 0.02;
  const Deviation d = deviation(flying_body(release, ball_mass(), Vec3::Zero()), stand_ins({net}));
  const auto energy = [](const RigidMotion& m) {
    return 0.34 * m.velocity.squaredNorm() + 0.5 * m.spin.dot(ball_mass().inertia * m.spin);
  };
  DeviationState state = d.start(0);
  double before = energy(release);
  for (int i = 1; i <= 100; ++i) {
    const DeviationStep step = advance(d, state, 0.01 * i);
    EXPECT_LT(step.work, 0);
    EXPECT_NEAR(step.work, energy(step.motion) - before, 1e-9);
    before = energy(step.motion);
  }
}

TEST(Deviation, Quadratic_drag_follows_its_closed_form_and_does_not_depend_on_the_step) {
  // A diver's entry: v = v0 / (1 + v0 t / l), l = M / c2.
  RigidMotion release;
  release.velocity = Vec3(0, -14.01, 0);
  StandInSpec water = field(0);
  water.damping_quadratic = 25;
  double errors[2];
  for (int halvings = 0; halvings < 2; ++halvings) {
    DeviationSettings settings;
    settings.step = std::ldexp(1.0 / 240, -halvings);
    settings.tolerance = 1;  // nothing is halved but by us
    const Deviation d =
        deviation(flying_body(release, {70, 5 * Mat3::Identity()}, Vec3::Zero()), stand_ins({water}), settings);
    DeviationState state = d.start(0);
    const double v = advance(d, state, 0.5).motion.velocity.y();
    errors[halvings] = std::abs(v + 14.01 / (1 + 14.01 * 0.5 * 25 / 70));
  }
  EXPECT_LT(errors[0], 1e-3);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.4);  // second order
}

TEST(Deviation, A_tumbling_body_that_was_pushed_flies_on_as_a_free_body_does) {
  const RigidMass mass{2, Vec3(0.1, 0.2, 0.15).asDiagonal()};
  RigidMotion release;
  release.velocity = Vec3(2, 3, 0), release.spin = Vec3(2, 1, -3);
  double errors[2];
  for (int halvings = 0; halvings < 2; ++halvings) {
    StandInSpec gate;
    gate.until = 0.2;
    std::vector<std::unique_ptr<StandIn>> acting;
    acting.push_back(std::make_unique<ConstantForce>(Vec3(5, 0, 1), Vec3(0.5, -0.4, 0.8), gate));
    DeviationSettings settings;
    settings.step = std::ldexp(1.0 / 240, -halvings);
    const Deviation d = deviation(flying_body(release, mass, Vec3(0, -k_gravity, 0)), std::move(acting), settings);
    DeviationState state = d.start(0);
    const RigidFlight flight(advance(d, state, 0.2).motion, mass);
    EXPECT_GT(rotation_vector(state.offset.rotation).norm(), 0.05);
    const RigidMotion m = advance(d, state, 0.7).motion, expected = flight.at(0.5);
    EXPECT_LT((m.pose.position - expected.pose.position).norm(), 1e-12);
    EXPECT_LT(
        (world_inertia(mass, m.pose.rotation) * m.spin - world_inertia(mass, expected.pose.rotation) * expected.spin)
            .norm(),
        1e-9);
    errors[halvings] = m.pose.rotation.angularDistance(expected.pose.rotation);
  }
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.4);  // second order
}

TEST(Deviation, Refuses_bodies_and_settings_that_make_no_sense) {
  EXPECT_FALSE(Deviation::make(still_body({}), {}, {}));
  DeviationSettings coarse;
  coarse.step = 0.01;
  EXPECT_FALSE(Deviation::make(still_body(ball_mass()), {}, coarse));
  DeviationSettings limited;
  limited.max_displacement = 0;
  EXPECT_FALSE(Deviation::make(still_body(ball_mass()), {}, limited));
}

TEST(Deviation, A_sampled_motion_passes_through_its_samples_and_follows_a_parabola) {
  RigidMotion release;
  release.velocity = Vec3(1, 5, 0), release.spin = Vec3(0, 2, 0);
  const RigidFlight flight(release, ball_mass());
  std::vector<RigidMotion> samples;
  for (int i = 0; i <= 24; ++i) samples.push_back(flight.at(i / 24.0));
  const auto motion = sampled_motion(2, 1 / 24.0, samples);
  EXPECT_EQ(motion(2).pose.position, release.pose.position);
  for (const double t : {0.01, 0.3, 0.77, 0.99}) {
    EXPECT_LT((motion(2 + t).pose.position - flight.at(t).pose.position).norm(), 1e-13);
    EXPECT_LT((motion(2 + t).velocity - flight.at(t).velocity).norm(), 1e-12);
    EXPECT_LT(motion(2 + t).pose.rotation.angularDistance(flight.at(t).pose.rotation), 1e-7);
  }
}

}  // namespace
}  // namespace ft

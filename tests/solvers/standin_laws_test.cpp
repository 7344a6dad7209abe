// The laws of the stand-ins against closed forms.
#include <random>

#include "deviation_scene.h"
#include "solvers/standins/fit.h"

namespace ft {
namespace {

using namespace test;

Wrench act(const StandInSpec& spec, const BodyState& body) {
  auto made = make_stand_in(spec);
  if (!made) ADD_FAILURE() << made.error().text();
  return made ? (*made)->act(body).wrench : Wrench();
}

TEST(StandInLaws, A_ball_half_in_the_volume_is_damped_by_half) {
  StandInSpec net = field(4);
  net.size = Vec3(2, 2, 2);
  const auto ball = sphere_shape(0.121);
  BodyState body;
  body.mass = 0.68, body.shape = ball;
  body.motion.velocity = Vec3(0, -3, 0);
  EXPECT_NEAR(act(net, body).force.y(), 12, 1e-12);
  body.motion.pose.position.y() = 1;
  EXPECT_NEAR(act(net, body).force.y(), 6, 1e-12);
  body.motion.pose.position.y() = 1.2;
  EXPECT_EQ(act(net, body).force.y(), 0);
}

TEST(StandInLaws, A_box_as_a_mesh_damps_as_the_box) {
  StandInSpec box = field(4);
  box.size = Vec3(1, 2, 3), box.soft_edge = 0.2;
  StandInSpec mesh = box;
  mesh.shape = VolumeShape::k_mesh;
  mesh.mesh.positions = {{-.5, -1, -1.5}, {.5, -1, -1.5}, {.5, 1, -1.5}, {-.5, 1, -1.5},
                         {-.5, -1, 1.5},  {.5, -1, 1.5},  {.5, 1, 1.5},  {-.5, 1, 1.5}};
  mesh.mesh.face_sizes.assign(6, 4);
  mesh.mesh.face_vertices = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 2, 3, 7, 6, 0, 4, 7, 3, 1, 2, 6, 5};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  BodyState body;
  body.mass = 1, body.motion.velocity = Vec3(1, 2, 3);
  for (int i = 0; i < 200; ++i) {
    body.motion.pose.position = Vec3(0.7 * u(random), 1.3 * u(random), 1.8 * u(random));
    EXPECT_LT((act(box, body).force - act(mesh, body).force).norm(), 1e-12);
  }
  mesh.mesh.face_sizes.pop_back();
  mesh.mesh.face_vertices.resize(20);
  EXPECT_FALSE(make_stand_in(mesh));  // open
}

TEST(StandInLaws, The_cone_is_as_wide_as_its_rims) {
  StandInSpec net = field(1);
  net.shape = VolumeShape::k_cone, net.height = 0.4, net.radius_top = 0.225, net.radius_bottom = 0.12;
  net.position = Vec3(0, 3, 0);
  BodyState body;
  body.mass = 1, body.motion.velocity = Vec3(0, -1, 0);
  for (const double y : {-0.19, 0.0, 0.19}) {
    const double radius = 0.1725 + y / 0.4 * 0.105;
    body.motion.pose.position = Vec3(radius - 1e-6, 3 + y, 0);
    EXPECT_EQ(act(net, body).force.y(), 1);
    body.motion.pose.position.x() = radius + 1e-6;
    EXPECT_EQ(act(net, body).force.y(), 0);
  }
}

TEST(StandInLaws, A_carried_weight_is_its_weight_at_rest_and_nothing_in_free_fall) {
  StandInSpec vest;
  vest.kind = "weight", vest.mass = 0.5, vest.anchor = Vec3(0.1, 0, 0);
  BodyState body;
  body.mass = 46.56;
  Wrench w = act(vest, body);
  EXPECT_EQ(w.force, Vec3(0, -0.5 * k_gravity, 0));
  EXPECT_EQ(w.torque, Vec3(0, 0, -0.1 * 0.5 * k_gravity));
  EXPECT_NEAR(w.force.norm() / 46.56, 0.105, 5e-4);  // the vest of O'Brien, Zordan & Hodgins 2000
  body.acceleration = Vec3(0, -k_gravity, 0);
  w = act(vest, body);
  EXPECT_EQ(w.force.norm(), 0);
}

TEST(StandInLaws, A_carried_weight_is_accelerated_with_its_body) {
  StandInSpec pack;
  pack.kind = "weight", pack.mass = 2;
  const RigidMass mass{8, Mat3::Identity()};
  const Deviation d = deviation(still_body(mass), stand_ins({pack}));
  DeviationState state = d.start(0);
  advance(d, state, 0.5);
  EXPECT_NEAR(state.velocity.y(), -2 * k_gravity / (8 + 2) * 0.5, 1e-12);
}

TEST(StandInLaws, A_bungee_jump_falls_as_deep_as_energy_says) {
  // 75 kg, 15 m of cord, kL = 4000 N: 27.266 m at 9.81 m/s2.
  StandInSpec cord;
  cord.kind = "spring", cord.length = 15, cord.stiffness = 4000.0 / 15;
  const Vec3 gravity(0, -9.81, 0);
  DeviationSettings settings;
  settings.gravity = gravity;
  const Deviation d = deviation(flying_body({}, {75, 10 * Mat3::Identity()}, gravity), stand_ins({cord}), settings);
  DeviationState state = d.start(0);
  double lowest = 0, force = 0;
  for (int i = 1; i <= 2400; ++i) {
    const DeviationStep step = advance(d, state, i / 480.0);
    lowest = std::min(lowest, step.motion.pose.position.y());
    force = std::max(force, step.peak);
  }
  const double k = cord.stiffness, weight = 75 * 9.81;
  const double stretch = weight / k + std::sqrt(weight * weight / (k * k) + 2 * weight * 15 / k);
  EXPECT_NEAR(stretch, 12.266, 5e-4);
  EXPECT_NEAR(lowest, -15 - stretch, 1e-3);
  EXPECT_NEAR(force, k * stretch, 1);
}

TEST(StandInLaws, A_floating_box_bobs_about_the_draft_that_its_density_says) {
  StandInSpec pond;
  pond.name = "pond", pond.kind = "water", pond.support = Support::k_replace, pond.drag = 0;
  const auto box = box_shape(Vec3(0.5, 0.5, 0.5), 4);
  const double mass = 0.5 * 1000 * 0.125, w = std::sqrt(1000 * k_gravity * 0.25 / mass);
  EXPECT_NEAR(2 * std::numbers::pi / w, 1.0030, 5e-4);
  YieldingBody body = still_body({mass, mass * 0.25 / 6 * Mat3::Identity()});
  body.shape = [&](double) { return std::span<const ShapeSample>(box); };
  for (const double lifted : {0.0, 0.02}) {  // above its draft, half of its height
    const double held = 0.125 * 0.5 + lifted;
    pond.position.y() = -held + 0.125 * 0.5;
    const Deviation d = deviation(body, stand_ins({pond}));
    DeviationState state = d.start(0);
    for (const double t : {0.2, 0.77, 1.5}) {
      advance(d, state, t);
      EXPECT_NEAR(state.offset.position.y(), -lifted * (1 - std::cos(w * t)), 1e-11);
      EXPECT_LT(state.offset.position.x(), 1e-12);
      EXPECT_LT(rotation_vector(state.offset.rotation).norm(), 1e-9);
    }
  }
}

TEST(StandInLaws, Drag_brings_a_dropped_raft_to_rest_at_its_draft) {
  StandInSpec pond;
  pond.name = "pond", pond.kind = "water", pond.support = Support::k_replace, pond.drag = 1.2;
  const auto raft = box_shape(Vec3(1, 0.2, 1), 5);
  const double mass = 0.35 * 1000 * 0.2;
  YieldingBody body = still_body({mass, Vec3(mass * 1.04 / 12, mass / 6, mass * 1.04 / 12).asDiagonal()});
  body.shape = [&](double) { return std::span<const ShapeSample>(raft); };
  pond.position.y() = -0.15;  // 5 cm below it
  const Deviation d = deviation(body, stand_ins({pond}));
  DeviationState state = d.start(0);
  advance(d, state, 10);
  // Its underside is 0.35 x 0.2 m below the water. Drag of one side (what faces the motion), averaged over a bob, lets
  // the amplitude fade as A' = -2 / (3 pi) c2 w A^2 / M, however high it was dropped from.
  const double c2 = 0.5 * 1000 * 1.2, w = std::sqrt(1000 * k_gravity / mass);
  const double amplitude = 3 * std::numbers::pi * mass / (2 * c2 * w * 10);
  EXPECT_LT(amplitude, 5e-3);
  EXPECT_NEAR(state.offset.position.y(), -0.15 - 0.35 * 0.2 + 0.1, amplitude);
}

TEST(StandInLaws, A_held_box_is_pushed_up_by_the_water_that_it_displaces) {
  StandInSpec pond;
  pond.kind = "water", pond.support = Support::k_replace;
  const auto box = box_shape(Vec3(0.5, 0.5, 0.5), 5);
  BodyState body;
  body.mass = 1, body.shape = box;
  for (const double y : {-1.0, -0.2, 0.0, 0.1234, 0.249, 0.3}) {
    body.motion.pose.position.y() = y;
    const double under = std::clamp(0.25 - y, 0.0, 0.5);
    EXPECT_NEAR(act(pond, body).force.y(), 1000 * k_gravity * 0.25 * under, 1e-9);
  }
}

TEST(StandInLaws, A_sinking_sphere_ends_at_its_terminal_velocity) {
  StandInSpec pond;
  pond.kind = "water", pond.support = Support::k_replace, pond.drag = 0.47;
  const double r = 0.05, volume = 4 * std::numbers::pi / 3 * r * r * r, mass = 2 * 1000 * volume;
  const auto ball = sphere_shape(r, 10);
  YieldingBody body = still_body({mass, 0.4 * mass * r * r * Mat3::Identity()});
  body.shape = [&](double) { return std::span<const ShapeSample>(ball); };
  const Deviation d = deviation(body, stand_ins({pond}));
  DeviationState state = d.start(0);
  advance(d, state, 2);
  EXPECT_NEAR(state.velocity.y(), -std::sqrt(8 * r * k_gravity / (3 * 0.47)), 0.02 * 1.67);
}

Vec6 stacked(const Wrench& w) {
  Vec6 out;
  out << w.force, w.torque;
  return out;
}

TEST(StandInLaws, Derivatives_by_place_and_turn_and_by_the_samples_own_motion_are_those_of_the_wrench) {
  StandInSpec cord;
  cord.kind = "spring", cord.length = 0.4, cord.stiffness = 300, cord.anchor = Vec3(0.1, 0.2, -0.3);
  StandInSpec mat = field(0);
  mat.kind = "mat", mat.support = Support::k_replace, mat.stiffness = 5e3, mat.stiffness_cubic = 1e5;
  for (const StandInSpec& spec : {cord, mat}) {
    auto made = make_stand_in(spec);
    ASSERT_TRUE(made) << made.error().text();
    std::vector<ShapeSample> point(1);  // alone: shares do not change as it turns
    point[0].place = Vec3(0.1, -0.2, 0.15), point[0].normal = Vec3(0, -1, 0), point[0].area = 1;
    BodyState body;
    body.mass = 3, body.shape = point;
    body.motion.pose = {Vec3(0.3, -0.6, 0.5), rotation_by(Vec3(0.3, -0.5, 0.2))};
    const StandInForce f = (*made)->act(body);
    constexpr double k_step = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const auto moved = [&](double by) {
        BodyState other = body;
        if (k < 3) other.motion.pose.position[k] += by;
        if (k >= 3) other.motion.pose.rotation = rotation_by(by * Vec3::Unit(k - 3)) * body.motion.pose.rotation;
        return stacked((*made)->act(other).wrench);
      };
      const Vec6 difference = (moved(k_step) - moved(-k_step)) / (2 * k_step);
      EXPECT_LT((difference + f.stiffness.col(k)).norm(), 1e-6 * (1 + f.stiffness.norm())) << spec.kind << k;
    }
    if (spec.kind == "spring") continue;  // no sample of the body
    point[0].velocity = Vec3(0.5, -1, 2);
    const Vec6 rate = stacked((*made)->act(body).rate), begin = stacked((*made)->act(body).wrench);
    point[0].place += k_step * point[0].velocity;
    EXPECT_LT((stacked((*made)->act(body).wrench) - begin - k_step * rate).norm(), 1e-5 * k_step * rate.norm());
  }
}

/// Forces of a known law at random motions, with noise of this size beside them.
std::vector<ForceSample> recorded(double c, double k, double noise, int count) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  std::vector<ForceSample> out(static_cast<std::size_t>(count));
  for (ForceSample& s : out) {
    s.velocity = 3 * vector(), s.displacement = 0.1 * vector();
    s.force = -c * s.velocity - k * s.displacement + noise * vector();
  }
  return out;
}

TEST(StandInFit, Finds_the_constants_that_the_forces_were_made_with) {
  const StandInFit exact = fit_stand_in(recorded(3.9, 60, 0, 50));
  EXPECT_NEAR(exact.damping, 3.9, 1e-12);
  EXPECT_NEAR(exact.stiffness, 60, 1e-10);
  EXPECT_NEAR(exact.r2, 1, 1e-12);
  const StandInFit noisy = fit_stand_in(recorded(3.9, 60, 2, 2000));
  EXPECT_NEAR(noisy.damping, 3.9, 0.05);  // 2 / (3 sqrt(6000)) is one standard deviation: 0.009
  EXPECT_NEAR(noisy.stiffness, 60, 1.5);  // 2 / (0.1 sqrt(6000)): 0.26
  const double signal = 3.9 * 3.9 * 9 + 60 * 60 * 0.01;
  EXPECT_NEAR(noisy.r2, signal / (signal + 4), 0.02);
  EXPECT_NE(noisy.text().find("2000 samples"), std::string::npos);
  EXPECT_NE(noisy.text().find("R2 0.97"), std::string::npos);
}

TEST(StandInFit, Unrelated_forces_explain_nothing) {
  const StandInFit fit = fit_stand_in(recorded(0, 0, 5, 2000));
  EXPECT_LT(fit.r2, 0.01);
  EXPECT_EQ(fit_stand_in({}).r2, 0);
  // Forces that push along the motion are no damping.
  EXPECT_EQ(fit_stand_in(recorded(-3, 0, 0, 20)).damping, 0);
}

TEST(StandInFit, A_fitted_field_turns_a_ball_around_as_a_damped_spring_does) {
  StandInSpec net = field(0);
  net.kind = "fitted";
  const StandInFit fit = fit_stand_in(recorded(1.5, 60, 0, 50));
  net.damping = fit.damping, net.stiffness = fit.stiffness;
  RigidMotion release;
  release.velocity = Vec3(4, 0, 0);
  const Deviation d = deviation(flying_body(release, ball_mass(), Vec3::Zero()), stand_ins({net}));
  DeviationState state = d.start(0);
  const double t = 0.31, rate = 1.5 / (2 * 0.68), w = std::sqrt(60 / 0.68 - rate * rate);
  const RigidMotion m = advance(d, state, t).motion;
  EXPECT_NEAR(m.pose.position.x(), 4 / w * std::exp(-rate * t) * std::sin(w * t), 1e-10);
  EXPECT_LT(m.velocity.x(), -0.5);
}

}  // namespace
}  // namespace ft

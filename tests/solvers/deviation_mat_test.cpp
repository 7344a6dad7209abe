// Landing on a mat: the clip's own support is replaced by the mat's.
#include <cmath>

#include "deviation_scene.h"

namespace ft {
namespace {

using namespace test;

constexpr double k_mass = 64.38, k_stiffness = 66e3, k_ratio = 0.35, k_speed = 4, k_g = 9.81;
constexpr double k_height = 1;  // of the centre of mass over the soles

StandInSpec mat() {
  StandInSpec spec;
  spec.name = spec.kind = "mat";
  spec.support = Support::k_replace;
  spec.size = Vec3(4, 0, 4);
  spec.stiffness = k_stiffness, spec.damping_ratio = k_ratio;
  return spec;
}

/// Falls onto a hard floor at height 0, which its soles touch at time 0 with 4 m/s. There they stop dead, and the
/// centre of mass stops evenly within `landing` seconds (legs bend): the soles are samples that move against it.
struct Gymnast {
  double landing = 0;
  std::vector<ShapeSample> soles = std::vector<ShapeSample>(4);

  Gymnast(double stops_within) : landing(stops_within) {
    for (int i = 0; i < 4; ++i) {
      soles[at(i)].place = Vec3(i % 2 ? 0.1 : -0.1, 0, i < 2 ? 0.1 : -0.1);
      soles[at(i)].normal = Vec3(0, -1, 0), soles[at(i)].area = 0.01;
    }
  }
  RigidMotion motion(double t) const {
    RigidMotion m;
    m.velocity.y() = -k_speed * (landing > 0 ? std::clamp(1 - t / landing, 0.0, 1.0) : 0);
    m.pose.position.y() = k_height + (m.velocity.y() - k_speed) * std::clamp(t, 0.0, landing) / 2;
    if (t >= 0) return m;
    m.velocity.y() = -k_speed - k_g * t;
    m.pose.position.y() = k_height - k_speed * t - 0.5 * k_g * t * t;
    return m;
  }
  YieldingBody driven() {
    return {{k_mass, 10 * Mat3::Identity()},
            [this](double t) { return motion(t); },
            [this](double t) {
              const RigidMotion m = motion(t);
              for (ShapeSample& s : soles) {
                s.place.y() = t < 0 ? -k_height : -m.pose.position.y();
                s.velocity.y() = t < 0 ? 0 : -m.velocity.y();
              }
              return std::span<const ShapeSample>(soles);
            }};
  }
};

struct Landing {
  double lowest = 0, peak = 0, end = 0;
};

Landing land(Gymnast gymnast, StandInSpec spec = mat(), double step = 1.0 / 240, double end = 2) {
  DeviationSettings settings;
  settings.step = step;
  settings.gravity = Vec3(0, -k_g, 0);
  const Deviation d = deviation(gymnast.driven(), stand_ins({spec}), settings);
  DeviationState state = d.start(-0.3);
  Landing out;
  for (int i = 1; - 0.3 + i / 480.0 <= end; ++i) {
    const DeviationStep s = advance(d, state, -0.3 + i / 480.0);
    out.lowest = std::min(out.lowest, state.offset.position.y());
    out.peak = std::max(out.peak, s.peak);
    EXPECT_TRUE(state.time >= -1e-9 || state.is_zero());
  }
  out.end = state.offset.position.y();
  EXPECT_TRUE(d.untouched(state).empty());
  return out;
}

/// M x'' = -k x - c x' - M g from x = 0 at -4 m/s: the lowest place.
double lowest_by_formula(double ratio) {
  const double w = std::sqrt(k_stiffness / k_mass), sink = k_g / (w * w), damped = w * std::sqrt(1 - ratio * ratio);
  const double b = (-k_speed + ratio * w * sink) / damped;  // x = -sink + e^(-zeta w t) (sink cos + b sin)
  double lowest = 0;
  for (double t = 0; t < 0.2; t += 1e-6)
    lowest =
        std::min(lowest, -sink + std::exp(-ratio * w * t) * (sink * std::cos(damped * t) + b * std::sin(damped * t)));
  return lowest;
}

TEST(DeviationMat, A_clip_that_stops_dead_falls_on_into_the_mat_as_a_direct_landing) {
  const Landing l = land(Gymnast(0));
  EXPECT_NEAR(l.lowest, lowest_by_formula(k_ratio), 1e-4);
  EXPECT_NEAR(l.end, -k_mass * k_g / k_stiffness, 1e-6);
  EXPECT_NEAR(l.end, -9.57e-3, 5e-6);
}

TEST(DeviationMat, A_landing_that_the_legs_take_up_in_a_tenth_of_a_second_sinks_by_63_mm) {
  const Landing l = land(Gymnast(0.1));
  EXPECT_NEAR(l.lowest, -63.5e-3, 0.01 * 63.5e-3);
  EXPECT_NEAR(l.peak, 4502, 0.01 * 4502);
  EXPECT_NEAR(l.end, -9.57e-3, 5e-6);
}

TEST(DeviationMat, An_undamped_landing_is_that_of_the_closed_form) {
  StandInSpec spec = mat();
  spec.damping_ratio = 0;
  const Landing l = land(Gymnast(0), spec, 1.0 / 240, 0.2);
  EXPECT_NEAR(l.lowest, -0.1349, 0.005 * 0.1349);
  EXPECT_NEAR(l.peak, 8902, 0.005 * 8902);
  EXPECT_NEAR(l.lowest, lowest_by_formula(0), 2e-4);  // seen at 480 Hz
}

TEST(DeviationMat, Standing_sinks_in_by_the_weight_over_the_stiffness) {
  StandInSpec spec = mat();
  spec.damping_ratio = 1;
  Gymnast gymnast(0);
  YieldingBody body = gymnast.driven();
  body.motion = [&](double) { return gymnast.motion(1); };
  body.shape = [shape = body.shape](double) { return shape(1); };
  const Deviation d = deviation(body, stand_ins({spec}));
  DeviationState state = d.start(0);
  advance(d, state, 3);
  EXPECT_NEAR(state.offset.position.y(), -k_mass * k_gravity / k_stiffness, 1e-12);
  EXPECT_EQ(state.offset.position.x(), 0);
}

TEST(DeviationMat, Does_not_depend_on_the_step) {
  const Landing coarse = land(Gymnast(0.1)), fine = land(Gymnast(0.1), mat(), 1.0 / 480);
  EXPECT_NEAR(coarse.lowest, fine.lowest, 2e-5);
  EXPECT_NEAR(coarse.end, fine.end, 1e-8);
}

TEST(DeviationMat, Beside_the_mat_the_clip_is_as_it_was_and_the_mat_is_reported) {
  StandInSpec spec = mat();
  spec.position.x() = 10;
  Gymnast gymnast(0.1);
  const Deviation d = deviation(gymnast.driven(), stand_ins({spec}));
  DeviationState state = d.start(-0.3);
  const DeviationStep step = advance(d, state, 1);
  EXPECT_TRUE(state.is_zero());
  EXPECT_EQ(step.motion.pose.position, gymnast.motion(1).pose.position);
  EXPECT_EQ(d.untouched(state), std::vector<std::string>{"mat"});
}

TEST(DeviationMat, The_clips_way_along_the_ground_stays) {
  Gymnast gymnast(0.1);
  YieldingBody body = gymnast.driven();
  body.motion = [motion = body.motion](double t) {  // a step forward that the feet brake
    RigidMotion m = motion(t);
    m.velocity.x() = t < 0 ? 2 : 2 * std::exp(-t / 0.1);
    m.pose.position.x() = t < 0 ? 2 * t : 0.2 * (1 - std::exp(-t / 0.1));
    return m;
  };
  DeviationSettings settings;
  settings.turn_axes = Vec3::Zero();
  settings.gravity = Vec3(0, -k_g, 0);
  const Deviation d = deviation(body, stand_ins({mat()}), settings);
  DeviationState state = d.start(-0.3);
  advance(d, state, 1);
  EXPECT_EQ(state.offset.position.x(), 0);
  EXPECT_NEAR(state.offset.position.y(), -9.57e-3, 2e-5);
}

TEST(DeviationMat, A_mat_that_would_be_added_to_the_ground_is_refused_with_the_reason) {
  StandInSpec spec = mat();
  spec.support = Support::k_add;
  const auto refused = make_stand_in(spec);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::k_usage);
  EXPECT_NE(refused.error().text().find("hold the body twice"), std::string::npos);
  EXPECT_NE(refused.error().text().find("support = \"replace\""), std::string::npos);
}

}  // namespace
}  // namespace ft

// What holds for every stand-in of the list.
#include <cmath>
#include <random>

#include "deviation_scene.h"

namespace ft {
namespace {

using namespace test;

/// One of each kind, about the origin; a new kind needs a line.
std::vector<StandInSpec> examples(std::string_view kind) {
  StandInSpec s = field(4);
  s.name = s.kind = kind;
  s.size = Vec3(1, 0.8, 1.4), s.soft_edge = 0.1, s.heading = 0.3;
  if (kind == "damping") {
    s.damping_quadratic = 2, s.damping_spin = 0.1, s.damping_axes = Vec3(1, 0.2, 2);
    StandInSpec cone = s, mesh = s;
    cone.shape = VolumeShape::k_cone, cone.radius_top = 0.5, cone.radius_bottom = 0.2, cone.height = 0.9;
    mesh.shape = VolumeShape::k_mesh;
    const double r = 0.7;
    mesh.mesh = make_triangle_mesh(
        "octahedron", {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
        std::vector<Triangle>{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
    return {s, cone, mesh};
  }
  if (kind == "mat") {
    s.support = Support::k_replace;
    s.stiffness = 5e3, s.stiffness_cubic = 1e4, s.damping_ratio = 0.3;
    return {s};
  }
  if (kind == "water") {
    s.support = Support::k_replace;
    s.slam = 2;
    return {s};
  }
  if (kind == "spring") {
    s.stiffness = 300, s.length = 0.3, s.anchor = Vec3(0.05, 0.1, 0);
    return {s};
  }
  if (kind == "weight") {
    s.mass = 0.5, s.anchor = Vec3(0, 0.1, 0.02);
    return {s};
  }
  if (kind == "fitted") {
    s.stiffness = 50;
    return {s};
  }
  ADD_FAILURE() << "no example of " << kind;
  return {};
}

struct Probe {
  std::unique_ptr<StandIn> stand_in;
  std::vector<ShapeSample> shape = box_shape(Vec3(0.3, 0.2, 0.25), 4);
  BodyState body;
  explicit Probe(const StandInSpec& spec) {
    auto made = make_stand_in(spec);
    if (!made) ADD_FAILURE() << made.error().text();
    stand_in = std::move(*made);
    body.mass = 3, body.shape = shape;
  }
  Vec6 wrench() const {
    const Wrench w = stand_in->act(body).wrench;
    Vec6 out;
    out << w.force, w.torque;
    return out;
  }
};

class StandIns : public testing::TestWithParam<std::string_view> {
 protected:
  std::mt19937 random_{7};
  Vec3 vector(double size) {
    std::uniform_real_distribution<double> u(-size, size);
    return Vec3(u(random_), u(random_), u(random_));
  }
  void shake(BodyState& body, double far = 0.6) {
    body.motion.pose.position = vector(far);
    body.motion.pose.rotation = rotation_by(vector(2));
    body.motion.velocity = vector(3), body.motion.spin = vector(4);
    body.acceleration = vector(5), body.spin_rate = vector(5);
  }
};

TEST_P(StandIns, Keeps_its_promise_about_energy_and_acts_somewhere) {
  for (const StandInSpec& spec : examples(GetParam())) {
    Probe probe(spec);
    int acting = 0;
    for (int i = 0; i < 500; ++i) {
      shake(probe.body);
      const StandInForce f = probe.stand_in->act(probe.body);
      const double power = f.wrench.force.dot(probe.body.motion.velocity) + f.wrench.torque.dot(probe.body.motion.spin);
      if (f.wrench.force.norm() > 0) ++acting;
      if (probe.stand_in->is_dissipative()) {
        EXPECT_LE(power, 0);
      }
    }
    EXPECT_GT(acting, 100);
  }
}

TEST_P(StandIns, Does_nothing_where_it_does_not_reach_outside_its_time_and_at_gain_zero) {
  for (StandInSpec spec : examples(GetParam())) {
    spec.from = 1, spec.until = 2;
    Probe probe(spec);
    for (int i = 0; i < 300; ++i) {
      shake(probe.body, 3);
      probe.body.time = 0.99;
      EXPECT_EQ(probe.wrench(), Vec6::Zero().eval());
      probe.body.time = 2;
      EXPECT_EQ(probe.wrench(), Vec6::Zero().eval());
      probe.body.time = 1;
      if (!probe.stand_in->reaches(probe.body, 0)) {
        EXPECT_EQ(probe.wrench(), Vec6::Zero().eval());
      }
    }
    spec.gain = 0;
    Probe off(spec);
    off.body.time = 1.5;
    EXPECT_EQ(off.wrench(), Vec6::Zero().eval());
  }
}

TEST_P(StandIns, Gain_scales_and_the_limit_holds) {
  for (StandInSpec spec : examples(GetParam())) {
    Probe plain(spec);
    spec.gain = 2.5;
    Probe strong(spec);
    spec.limit_force = 3;
    Probe limited(spec);
    for (int i = 0; i < 200; ++i) {
      shake(plain.body);
      strong.body.motion = limited.body.motion = plain.body.motion;
      strong.body.acceleration = limited.body.acceleration = plain.body.acceleration;
      strong.body.spin_rate = limited.body.spin_rate = plain.body.spin_rate;
      const Vec6 w = strong.wrench(), l = limited.wrench();
      EXPECT_LE((w - 2.5 * plain.wrench()).norm(), 1e-12 * (1 + w.norm()));
      EXPECT_LE(l.head<3>().norm(), 3 * (1 + 1e-12));
      EXPECT_LE((l * w.norm() - w * l.norm()).norm(), 1e-12 * (1 + w.norm() * l.norm()));
    }
  }
}

TEST_P(StandIns, Changes_smoothly_along_any_way_through_it) {
  for (const StandInSpec& spec : examples(GetParam())) {
    Probe probe(spec);
    shake(probe.body);
    // The damping of these sets in with the speed of the touch: Kelvin-Voigt.
    if (spec.kind == "mat" || spec.kind == "spring") probe.body.motion.velocity = probe.body.motion.spin = Vec3::Zero();
    constexpr int k_steps = 20000;
    const Vec3 begin(-1.5, -0.9, -0.8), end(1.4, 1, 0.6);
    Vec6 before = Vec6::Zero();
    double largest = 0, jump = 0;
    for (int i = 0; i <= k_steps; ++i) {
      probe.body.motion.pose.position = begin + (end - begin) * i / k_steps;
      const Vec6 w = probe.wrench();
      if (i > 0) jump = std::max(jump, (w - before).norm());
      largest = std::max(largest, w.norm());
      before = w;
    }
    EXPECT_LT(jump, 5e-3 * largest) << spec.kind << " " << static_cast<int>(spec.shape);
  }
}

TEST_P(StandIns, Moved_and_turned_about_the_vertical_with_its_body_the_wrench_turns_along) {
  for (StandInSpec spec : examples(GetParam())) {
    const double angle = 0.7;
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
    const Vec3 move(3, -2, 5);
    StandInSpec moved = spec;
    moved.position = turn * spec.position + move, moved.heading += angle;
    Probe a(spec), b(moved);
    for (int i = 0; i < 200; ++i) {
      shake(a.body);
      b.body.motion.pose.position = turn * a.body.motion.pose.position + move;
      b.body.motion.pose.rotation = Quat(turn) * a.body.motion.pose.rotation;
      b.body.motion.velocity = turn * a.body.motion.velocity, b.body.motion.spin = turn * a.body.motion.spin;
      b.body.acceleration = turn * a.body.acceleration, b.body.spin_rate = turn * a.body.spin_rate;
      const Vec6 w = a.wrench(), v = b.wrench();
      EXPECT_LT((turn * w.head<3>() - v.head<3>()).norm(), 1e-9 * (1 + w.norm()));
      EXPECT_LT((turn * w.tail<3>() - v.tail<3>()).norm(), 1e-9 * (1 + w.norm()));
    }
  }
}

TEST_P(StandIns, Its_derivative_by_velocity_and_acceleration_is_that_of_the_wrench) {
  for (const StandInSpec& spec : examples(GetParam())) {
    Probe probe(spec);
    for (int i = 0; i < 100; ++i) {
      shake(probe.body);
      const StandInForce f = probe.stand_in->act(probe.body);
      constexpr double k_dt = 1e-5;
      for (int k = 0; k < 6; ++k) {
        const auto difference = [&](Vec3& a, Vec3& b) {
          double& value = k < 3 ? a[k] : b[k - 3];
          const double kept = value;
          value = kept + k_dt;
          const Vec6 above = probe.wrench();
          value = kept - k_dt;
          const Vec6 below = probe.wrench();
          value = kept;
          return Vec6((above - below) / (2 * k_dt));
        };
        RigidMotion& m = probe.body.motion;
        const double size = 1 + probe.wrench().norm() + f.damping.norm();
        if (spec.kind != "weight") {  // whose centrifugal part is left out
          EXPECT_LT((difference(m.velocity, m.spin) + f.damping.col(k)).norm(), 1e-4 * size) << spec.kind;
        }
        EXPECT_LT((difference(probe.body.acceleration, probe.body.spin_rate) + f.inertia.col(k)).norm(), 1e-4 * size);
      }
    }
  }
}

TEST_P(StandIns, Stays_finite_for_wild_input) {
  for (const StandInSpec& spec : examples(GetParam())) {
    Probe probe(spec);
    for (const double size : {1e-12, 1e3, 1e9}) {
      for (int i = 0; i < 50; ++i) {
        shake(probe.body, size);
        probe.body.motion.velocity *= size, probe.body.motion.spin *= size;
        EXPECT_TRUE(probe.wrench().allFinite());
      }
    }
    probe.body = {};
    probe.body.mass = 1;
    EXPECT_TRUE(probe.wrench().allFinite());  // a point, in the very middle
  }
}

TEST_P(StandIns, Refuses_numbers_that_are_none_and_supports_only_as_it_can) {
  for (const StandInSpec& spec : examples(GetParam())) {
    StandInSpec bad = spec;
    bad.position.y() = std::nan("");
    EXPECT_FALSE(make_stand_in(bad));
    bad = spec;
    bad.until = bad.from = 3;
    EXPECT_FALSE(make_stand_in(bad));
    bad = spec;
    bad.support = spec.support == Support::k_add ? Support::k_replace : Support::k_add;
    const auto refused = make_stand_in(bad);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text().find("support = "), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(All, StandIns, testing::ValuesIn([] {
                           std::vector<std::string_view> names;
                           for (const StandInKind& kind : stand_in_kinds()) names.push_back(kind.name);
                           return names;
                         }()),
                         [](const auto& kind) { return std::string(kind.param); });

TEST(StandIn, A_kind_that_is_not_known_is_refused_with_the_list) {
  StandInSpec spec = field(1);
  spec.kind = "sponge";
  const auto refused = make_stand_in(spec);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("damping, mat, water, spring, weight, fitted"), std::string::npos);
}

}  // namespace
}  // namespace ft

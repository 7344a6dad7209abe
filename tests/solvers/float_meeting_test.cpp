// Floating bodies that meet: momentum, energy, and that they stay apart in all waters.
#include <gtest/gtest.h>

#include "solvers/water/float_motion.h"
#include "tests/solvers/three_waters.h"

namespace ft {
namespace {

using namespace test;

constexpr double k_size = 0.3;

TEST(FloatMeeting, Keeps_momentum_and_turns_the_approach) {
  // A box that a ball hits beside its middle, both in a turn, and water that goes with the box.
  const PlacedFloat box = floating("box", box_surface(Vec3(0.6, 0.3, 0.3)), 500, Vec3::Zero());
  const PlacedFloat ball = floating("ball", sphere_surface(0.2, 3), 700, Vec3(0.2, 0.1, 0.325));
  const std::vector<FloatingHull> hulls{float_model(box.body), float_model(ball.body)};
  std::vector<FloatState> floats(2);
  floats[0].motion = box.start, floats[1].motion = ball.start;
  floats[0].motion.velocity = Vec3(0.1, 0.2, 1), floats[0].motion.spin = Vec3(1, 0.5, -2);
  floats[1].motion.velocity = Vec3(0, 0.1, -2), floats[1].motion.spin = Vec3(0, 3, 1);
  floats[0].added_mass = 4;
  const auto mass = [&](std::size_t b) { return hulls[b].body.mass.mass + floats[b].added_mass; };
  const auto momentum = [&] { return Vec3(mass(0) * floats[0].motion.velocity + mass(1) * floats[1].motion.velocity); };
  const auto middle = [&] {
    return Vec3((mass(0) * floats[0].motion.pose.position + mass(1) * floats[1].motion.pose.position) /
                (mass(0) + mass(1)));
  };
  const auto depth = [&] {
    return deepest(hulls[0].contact, floats[0].motion.pose, hulls[1].contact, floats[1].motion.pose);
  };
  const Meeting before = depth();
  ASSERT_GT(before.depth, 0.001);
  const Vec3 p = momentum(), c = middle();
  MovedBody a{&hulls[0].body.mass, &floats[0].motion, 4}, b{&hulls[1].body.mass, &floats[1].motion, 0};
  const double energy = a.kinetic() + b.kinetic();
  // One meeting alone, to see the approach turned about.
  std::vector<FloatState> once = floats;
  meet({&hulls[0].body.mass, &once[0].motion, 4}, hulls[0].contact, {&hulls[1].body.mass, &once[1].motion, 0},
       hulls[1].contact, k_float_restitution);
  const double share = mass(1) / (mass(0) + mass(1));
  const Vec3 arm0 = before.place - floats[0].motion.pose.position, arm1 = before.place - floats[1].motion.pose.position;
  // From where they are after they were moved apart.
  const Vec3 moved0 = arm0 - before.depth * share * before.normal,
             moved1 = arm1 + before.depth * (1 - share) * before.normal;
  const auto closing = [&](const std::vector<FloatState>& s) {
    const RigidMotion &m0 = s[0].motion, &m1 = s[1].motion;
    return (m0.velocity + m0.spin.cross(moved0) - m1.velocity - m1.spin.cross(moved1)).dot(before.normal);
  };
  ASSERT_GT(std::abs(closing(floats)), 1);
  EXPECT_NEAR(closing(once), -k_float_restitution * closing(floats), 1e-12);
  meet_one_another(hulls, floats);
  EXPECT_LT((momentum() - p).norm(), 1e-12 * p.norm());
  EXPECT_LT((middle() - c).norm(), 1e-12);
  EXPECT_LT(depth().depth, 1e-9);
  EXPECT_LT(a.kinetic() + b.kinetic(), energy);
}

class FloatsOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, FloatsOf, testing::Values("shallow", "pond", "paper"),
                         [](const auto& p) { return std::string(p.param); });

TEST_P(FloatsOf, Boxes_and_balls_pushed_together_stay_apart) {
  for (const bool balls : {false, true}) {
    const TriangleSurface surface = balls ? sphere_surface(0.5 * k_size, 3) : box_surface(Vec3::Constant(k_size));
    std::vector<PlacedFloat> floats;
    for (const double side : {-1.0, 1.0}) {
      floats.push_back(floating(side < 0 ? "left" : "right", surface, 500, Vec3(0.3 * side, 0, 0), 1));
      floats.back().start.velocity = Vec3(-1.5 * side, 0, 0);
    }
    auto water = water_of(GetParam(), floats, 0.5, false);
    State state = water->initial_state();
    const double all = water->ledger(state).total();
    double least = 1, apart = -1;
    for (int f = 0; f < 24; ++f) {
      water->advance(state, 1 / 24.0, {});
      const auto now = water->floating(state);
      least = std::min(least, (now[1].pose.position - now[0].pose.position).norm());
      apart = std::max(apart, now[1].velocity.x() - now[0].velocity.x());
      ASSERT_NEAR(water->ledger(state).total(), all, 1e-12 * all);
    }
    // A ball of the mesh's volume, whose corners are a little farther out.
    EXPECT_GE(least, 2 * contact_spheres(floats[0].body).radius - 1e-9) << balls;
    EXPECT_LT(least, k_size + 0.1) << "they have come together, " << balls;
    EXPECT_GT(apart, 0.01) << "and bounced";
  }
}

}  // namespace
}  // namespace ft

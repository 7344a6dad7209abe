// How the pond sees a body: parts that sum to the whole, volumes below a level against brute force.
#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/random.h"
#include "tests/solvers/pond_scenes.h"

namespace ft {
namespace {

double uniform(int draw, double lo, double hi) {
  return lo + (hi - lo) * random_uniform({5, 0, 0, 0}, static_cast<std::uint64_t>(draw));
}

Submerged whole(const FloatShape& shape, const RigidPose& pose, double level) {
  Submerged sum;
  for (const FloatPart& p : shape.parts) {
    const Submerged s = submerged(p, pose, level);
    sum.volume += s.volume, sum.area += s.area, sum.centre += s.volume * s.centre;
  }
  if (sum.volume > 0) sum.centre /= sum.volume;
  return sum;
}

TEST(PondShape, Parts_of_a_body_sum_to_the_whole_in_any_attitude) {
  for (const Vec3& size : {Vec3(1.2, 0.3, 0.6), Vec3(0.5, 0.2, 3)}) {
    const PondFloat box = floating_box(size, 0.5, Vec3::Zero());
    const FloatShape shape = float_shape(box, 1000);
    EXPECT_GT(shape.parts.size(), 3u);
    FloatPart one;
    for (const Triangle& t : box.body.triangles)
      for (const int v : t) one.corners.push_back(box.body.positions[at(v)]);
    one.volume = size.prod();
    double sum = 0;
    for (const FloatPart& p : shape.parts) {
      sum += p.volume;
      EXPECT_NEAR(p.volume, size.prod() / static_cast<double>(shape.parts.size()), 1e-12);
    }
    EXPECT_NEAR(sum, size.prod(), 1e-12);
    for (int n = 0; n < 50; ++n) {
      RigidPose pose;
      pose.rotation =
          Quat(uniform(9 * n, -1, 1), uniform(9 * n + 1, -1, 1), uniform(9 * n + 2, -1, 1), uniform(9 * n + 3, -1, 1))
              .normalized();
      pose.position = Vec3(uniform(9 * n + 4, -3, 3), uniform(9 * n + 5, -0.5, 0.5), uniform(9 * n + 6, -3, 3));
      const Submerged a = whole(shape, pose, 0.1), b = submerged(one, pose, 0.1);
      ASSERT_NEAR(a.volume, b.volume, 1e-12);
      ASSERT_NEAR(a.area, b.area, 1e-11);
      if (b.volume > 1e-6) {
        ASSERT_LT((a.centre - b.centre).norm(), 1e-9);
      }
    }
  }
}

TEST(PondShape, The_volume_below_a_level_grows_by_the_area_of_the_cut) {
  const FloatShape shape = float_shape(floating_box(Vec3(1.2, 0.3, 0.6), 0.5, Vec3::Zero()), 1000);
  RigidPose pose;
  pose.rotation = Quat(Eigen::AngleAxisd(0.4, Vec3(0.3, 0.2, 0.9).normalized()));
  const double h = 1e-6;
  for (const FloatPart& p : shape.parts) {
    const Submerged s = submerged(p, pose, 0.03);
    EXPECT_NEAR((submerged(p, pose, 0.03 + h).volume - submerged(p, pose, 0.03 - h).volume) / (2 * h), s.area, 1e-6);
    EXPECT_GE(s.volume, 0);
    EXPECT_LE(s.volume, p.volume);
  }
}

TEST(PondShape, A_meshed_ball_is_a_ball) {
  const FloatShape shape = float_shape(floating_ball(0.3, 0.5, Vec3::Zero()), 1000);
  ASSERT_EQ(shape.parts.size(), 1u);
  EXPECT_NEAR(shape.parts[0].ball_radius, 0.3, 1e-12);
  EXPECT_NEAR(shape.depth, 0.3, 1e-9) << "half under, its kernel is Hulme's hemisphere";
  EXPECT_NEAR(shape.rest_height, 0, 1e-9);
}

TEST(PondShape, The_added_mass_of_a_round_box_is_a_balls) {
  // A cube half under: draft half its side, as an ellipsoid a ball.
  const FloatShape shape = float_shape(floating_box(Vec3(0.4, 0.4, 0.4), 0.5, Vec3::Zero()), 1000);
  EXPECT_NEAR(shape.added.x(), 0.5, 1e-3);
  EXPECT_NEAR(shape.added.y(), 0.5, 1e-3);
}

}  // namespace
}  // namespace ft

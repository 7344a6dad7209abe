// Keys, interpolation, decomposition: closed forms.
#include "io/import/character/pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/random.h"
#include "io/import/character/character.h"
#include "io/import/motion/character_trajectory.h"

namespace ft {
namespace {

double sample1(const Track& track, double time) {
  double v = 0;
  sample_track(track, time, false, {&v, 1});
  return v;
}

Quat sample_rotation(const Track& track, double time) {
  double v[4];
  sample_track(track, time, true, v);
  return {v[3], v[0], v[1], v[2]};
}

TEST(Track, Is_held_before_the_first_key_and_after_the_last) {
  const Track track{KeyInterpolation::k_linear, 1, {0.5, 1.5}, {3, 7}};
  EXPECT_EQ(sample1(track, -10), 3);
  EXPECT_EQ(sample1(track, 0.5), 3);
  EXPECT_EQ(sample1(track, 1.0), 5);
  EXPECT_EQ(sample1(track, 1.5), 7);
  EXPECT_EQ(sample1(track, 99), 7);
}

TEST(Track, Steps_stay_steps) {
  const Track track{KeyInterpolation::k_step, 1, {0, 1, 2}, {3, 7, 9}};
  EXPECT_EQ(sample1(track, 0.999999), 3);
  EXPECT_EQ(sample1(track, 1.0), 7);
  EXPECT_EQ(sample1(track, 1.5), 7);
  EXPECT_EQ(sample1(track, 2), 9);
}

TEST(Track, Cubic_keys_reproduce_a_cubic) {
  // f = t^3 - 2t, f' = 3t^2 - 2, with in-tangent, value, out-tangent at uneven keys.
  Track track{KeyInterpolation::k_cubic, 1, {0, 0.4, 1.7}, {}};
  for (const double t : track.times)
    track.values.insert(track.values.end(), {3 * t * t - 2, t * t * t - 2 * t, 3 * t * t - 2});
  for (double t = 0; t <= 1.7; t += 0.01) EXPECT_NEAR(sample1(track, t), t * t * t - 2 * t, 1e-13);
}

TEST(Track, Rotations_turn_evenly_and_the_short_way_round) {
  const double c = std::cos(0.25), s = std::sin(0.25);
  for (const double sign : {1.0, -1.0}) {  // q and -q are one rotation
    const Track track{KeyInterpolation::k_linear, 4, {0, 1}, {0, 0, 0, 1, 0, sign * s, 0, sign * c}};
    for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      const Quat q = sample_rotation(track, t);
      EXPECT_NEAR(q.norm(), 1, 1e-15);
      EXPECT_NEAR(std::remainder(2 * std::atan2(q.y(), q.w()) - 0.5 * t, 2 * M_PI), 0, 1e-12);
    }
  }
}

TEST(Track, Quaternions_of_any_length_are_rotations) {
  const Track track{KeyInterpolation::k_linear, 4, {0, 1}, {0, 0, 0, 7, 0, 0.003, 0, 0.003}};
  EXPECT_NEAR(Eigen::AngleAxisd(sample_rotation(track, 1)).angle(), M_PI / 2, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(sample_rotation(track, 0.5)).angle(), M_PI / 4, 1e-12);
  const Track none{KeyInterpolation::k_linear, 4, {0}, {0, 0, 0, 0}};
  EXPECT_EQ(sample_rotation(none, 0).coeffs(), Quat::Identity().coeffs());
}

TEST(Decompose, Gives_back_any_matrix_and_a_proper_rotation) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Mat4 m = Mat4::Identity();
    for (int k = 0; k < 12; ++k) m(k % 3, k / 3) = 4 * random_uniform({seed, 1}, static_cast<std::uint64_t>(k)) - 2;
    if (seed % 5 == 0) m.col(1) = m.col(0);  // singular
    if (seed % 7 == 0) m *= 1e-6, m(3, 3) = 1;
    const NodeTransform parts = decompose(m);
    EXPECT_LT((parts.matrix() - m).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(parts.rotation.norm(), 1, 1e-12);
  }
}

TEST(Decompose, Finds_rotation_and_scale_apart) {
  const Quat q(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()));
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() = q.toRotationMatrix() * Vec3(100, 100, 100).asDiagonal();
  const NodeTransform parts = decompose(m);
  EXPECT_LT(parts.rotation.angularDistance(q), 1e-12);
  EXPECT_LT((parts.stretch - 100 * Mat3::Identity()).norm(), 1e-10);
}

TEST(Heading, Is_the_turn_about_the_vertical) {
  for (const double yaw : {-3.0, -1.0, 0.0, 0.7, 3.1}) {
    const Mat3 turned =
        (Eigen::AngleAxisd(yaw, Vec3::UnitY()) * Eigen::AngleAxisd(0.4, Vec3::UnitX())).toRotationMatrix();
    EXPECT_NEAR(std::remainder(heading(turned) - yaw, 2 * M_PI), 0, 1e-12);
  }
  EXPECT_EQ(heading(Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix()), 0);
}

}  // namespace
}  // namespace ft

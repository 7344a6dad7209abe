// A geometry cache as a trajectory. Its parts: limbs with joints between them, or eyes and nails that ride on one skin.
// Its way between samples where it jumps, and the pose that garments are modelled on.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <numbers>

#include "io/import/motion/sampled_trajectory.h"

namespace ft {
namespace {

using Move = std::function<Vec3(int piece, double time, const Vec3& place)>;

/// A bar of 1 m along x and, at its end, a small one; ten samples of what `move` makes of them.
GeometryCache two_bars(const Move& move) {
  GeometryCache cache;
  std::vector<int> piece;
  const auto add_bar = [&](int own, double from, double length, double radius) {
    constexpr int k_rings = 11, k_around = 4;
    const int first = static_cast<int>(cache.mesh.positions.size());
    for (int r = 0; r < k_rings; ++r)
      for (int k = 0; k < k_around; ++k) {
        const double angle = 0.5 * std::numbers::pi * k;
        cache.mesh.positions.push_back(
            {from + length * r / (k_rings - 1), radius * std::cos(angle), radius * std::sin(angle)});
        piece.push_back(own);
        if (r + 1 == k_rings) continue;
        const int a = first + r * k_around + k, b = first + r * k_around + (k + 1) % k_around;
        cache.mesh.face_vertices.insert(cache.mesh.face_vertices.end(), {a, b, b + k_around, a + k_around});
        cache.mesh.face_sizes.push_back(4);
      }
  };
  add_bar(0, 0, 1, 0.1);
  add_bar(1, 0.95, 0.1, 0.02);
  cache.vertex_count = static_cast<int>(piece.size());
  for (int s = 0; s < 10; ++s) {
    cache.times.push_back(0.1 * s);
    for (std::size_t v = 0; v < piece.size(); ++v)
      cache.positions.push_back(move(piece[v], 0.1 * s, cache.mesh.positions[v]).cast<float>());
  }
  return cache;
}

SurfacePart small_part(const Move& move) {
  const SampledTrajectory trajectory(two_bars(move), Mat3::Identity(), 1, {});
  EXPECT_EQ(trajectory.surface().parts.size(), 2u);
  EXPECT_EQ(trajectory.surface().parts[1].parent, 0);
  return trajectory.surface().parts[1];
}

/// Turned about z by an angle [rad] at the place x = 1.
Vec3 turned(double angle, const Vec3& p) {
  const Vec3 joint(1, 0, 0);
  return joint + Eigen::AngleAxisd(angle, Vec3::UnitZ()) * (p - joint);
}

TEST(Pieces, That_keep_their_shapes_are_limbs_with_a_joint) {
  EXPECT_TRUE(small_part([](int piece, double t, const Vec3& p) { return piece == 0 ? p : turned(t, p); }).folds);
  EXPECT_TRUE(small_part([](int, double t, const Vec3& p) { return (p + Vec3(t, 0, 0)).eval(); }).folds);
}

TEST(Pieces, That_ride_on_a_skin_do_not_fold) {
  // The large bar bends like a finger; the small one, a nail at its end, goes along as it is.
  EXPECT_FALSE(small_part([](int piece, double t, const Vec3& p) {
                 return piece == 1 ? turned(t, p) : (p + Vec3(0, t * p.x() * p.x(), 0)).eval();
               }).folds);
  // Nor does a soft one on a stiff one.
  EXPECT_FALSE(small_part([](int piece, double t, const Vec3& p) {
                 return piece == 0 ? p : (p + Vec3(0, 3 * t * (p.x() - 0.95), 0)).eval();
               }).folds);
}

/// Vertex by vertex, where the bars are at a time of the shot.
std::vector<Vec3> at_time(const SampledTrajectory& trajectory, double time) {
  std::vector<Vec3> out(at(trajectory.surface().vertex_count()));
  trajectory.sample(time, out);
  return out;
}

TEST(Samples, A_jump_does_not_swing_the_body_out_before_and_after_it) {
  // 0.1 m in every interval, and 5 m to the side between samples 4 and 5.
  const auto place = [](double t) { return Vec3(t, 0, t > 0.45 ? 5 : 0); };
  const SampledTrajectory trajectory(two_bars([&](int, double t, const Vec3& p) { return (p + place(t)).eval(); }),
                                     Mat3::Identity(), 1, {});
  const std::vector<Vec3> start = at_time(trajectory, 0);
  for (const double t : {0.33, 0.37, 0.4, 0.5, 0.53, 0.58}) {
    const std::vector<Vec3> now = at_time(trajectory, t);
    for (std::size_t v = 0; v < now.size(); ++v)
      EXPECT_LT((now[v] - start[v] - place(t)).norm(), 1e-6) << t << " vertex " << v;
  }
}

TEST(Samples, A_part_of_the_shot_begins_in_the_pose_of_the_whole) {
  // The bar turns about its end and moves away; the part that is baked begins at 0.6 s.
  const Move move = [](int, double t, const Vec3& p) { return (turned(2 * t, p) + Vec3(0, 0, t)).eval(); };
  Playback playback;
  playback.start = 0.6;
  playback.bind = 0;
  const SampledTrajectory whole(two_bars(move), Mat3::Identity(), 1, {});
  const SampledTrajectory part(two_bars(move), Mat3::Identity(), 1, playback);
  std::vector<Vec3> bind(at(part.surface().vertex_count())), expected = bind;
  part.bind_pose(bind);
  whole.bind_pose(expected);
  EXPECT_EQ(bind, expected);
  // The motion is rigid: where the garment is put, the body is, all through the pre-roll until it runs up.
  const Eigen::Isometry3d placed = part.bind_to_start();
  for (const double t : {-1.0, -0.9, -0.7, -0.45}) {
    const std::vector<Vec3> now = at_time(part, t);
    for (std::size_t v = 0; v < now.size(); ++v) EXPECT_LT((now[v] - placed * bind[v]).norm(), 1e-6) << t;
  }
  const std::vector<Vec3> first = at_time(part, 0), same = at_time(whole, 0.6);
  for (std::size_t v = 0; v < first.size(); ++v) EXPECT_LT((first[v] - same[v]).norm(), 1e-9);
}

}  // namespace
}  // namespace ft

// Linear fields are given back exactly, nothing jumps at the edge, time is clamped.
#include "solvers/wind/velocity_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/random.h"

namespace ft {
namespace {

Vec3 linear_field(const Vec3& p, double t) {
  return {1 + 2 * p.x() - p.z() + t, 0.5 * p.y() - 3 * t, p.x() + p.y() + 4 * p.z()};
}

/// Voxels of 0.1 m, turned and moved, with the field at a time.
VelocityVoxels voxels(double t) {
  VelocityVoxels out;
  out.lowest = {-3, 5, 2}, out.count = {6, 5, 7};
  out.to_world =
      Eigen::Translation3d(1, -2, 0.5) * Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::Scaling(0.1);
  for (int k = 0; k < 7; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 6; ++i)
        out.velocities.push_back(linear_field(out.to_world * Vec3(i - 3, j + 5, k + 2), t).cast<float>());
  return out;
}

double uniform(std::uint64_t draw) {
  return static_cast<double>(random_bits({.seed = 7}, draw) >> 11) * 0x1p-53;
}

TEST(Velocity_grid, A_linear_field_is_given_back_between_voxels_and_frames) {
  const VelocityGrid grid({voxels(0), voxels(0.25), voxels(0.5)}, 10, 4);
  for (std::uint64_t n = 0; n < 300; ++n) {
    const Vec3 index(-3 + 5 * uniform(4 * n), 5 + 4 * uniform(4 * n + 1), 2 + 6 * uniform(4 * n + 2));
    const Vec3 place = grid.frames()[0].to_world * index;
    const double t = 0.5 * uniform(4 * n + 3);
    EXPECT_LT((grid.velocity(place, 10 + t) - linear_field(place, t)).norm(), 1e-6);  // floats are stored
  }
}

TEST(Velocity_grid, Before_the_first_and_after_the_last_frame_it_is_these) {
  const VelocityGrid grid({voxels(0), voxels(0.25)}, 1, 4);
  const Vec3 place = grid.frames()[0].to_world * Vec3(-1.5, 6.5, 4);
  EXPECT_EQ(grid.velocity(place, -1e9), grid.velocity(place, 1));
  EXPECT_EQ(grid.velocity(place, 1e9), grid.velocity(place, 1.25));
  EXPECT_NE(grid.velocity(place, 1), grid.velocity(place, 1.25));
}

TEST(Velocity_grid, It_fades_over_one_voxel_and_is_still_beyond) {
  const VelocityGrid grid({voxels(0)}, 0, 24);
  const auto& to_world = grid.frames()[0].to_world;
  const Vec3 inside(-3, 7, 4);  // a voxel of the lowest plane
  const Vec3 v = grid.velocity(to_world * inside, 0);
  for (const double out : {0.0, 1e-12, 0.25, 0.5, 0.999})
    EXPECT_LT((grid.velocity(to_world * (inside - Vec3(out, 0, 0)), 0) - (1 - out) * v).norm(), 1e-9) << out;
  for (const Vec3& index : {Vec3(-4.001, 7, 4), Vec3(3.001, 7, 4), Vec3(0, 3.999, 4), Vec3(0, 7, 9.001)})
    EXPECT_EQ(grid.velocity(to_world * index, 0), Vec3::Zero());
  for (const double far : {1e9, -1e9, 1e300}) EXPECT_EQ(grid.velocity(Vec3::Constant(far), 0), Vec3::Zero());
}

TEST(Velocity_grid, Nothing_is_faster_than_the_fastest) {
  const VelocityGrid grid({voxels(0), voxels(1)}, 0, 1);
  double most = 0;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    const Vec3 index(-5 + 9 * uniform(4 * n), 3 + 9 * uniform(4 * n + 1), 10 * uniform(4 * n + 2));
    most = std::max(most, grid.velocity(grid.frames()[0].to_world * index, uniform(4 * n + 3)).norm());
  }
  EXPECT_LE(most, grid.fastest());
  EXPECT_GT(most, 0.7 * grid.fastest());
}

TEST(Velocity_grid, A_frame_without_voxels_is_still) {
  VelocityVoxels none;
  none.to_world.setIdentity();
  const VelocityGrid grid({none, voxels(0)}, 0, 1);
  const Vec3 place = grid.frames()[1].to_world * Vec3(0, 7, 4);
  EXPECT_EQ(grid.velocity(place, 0), Vec3::Zero());
  EXPECT_LT((grid.velocity(place, 0.5) - 0.5 * grid.velocity(place, 1)).norm(), 1e-12);
}

TEST(Velocity_grid, One_voxel_is_a_hat) {
  VelocityVoxels one;
  one.to_world.setIdentity(), one.count = {1, 1, 1}, one.velocities = {Vec3f(2, 0, 0)};
  const VelocityGrid grid({one}, 0, 24);
  EXPECT_EQ(grid.velocity(Vec3::Zero(), 0), Vec3(2, 0, 0));
  EXPECT_EQ(grid.velocity(Vec3(0.5, 0, -0.5), 3), Vec3(0.5, 0, 0));
  EXPECT_EQ(grid.velocity(Vec3(1, 0, 0), 0), Vec3::Zero());
}

}  // namespace
}  // namespace ft

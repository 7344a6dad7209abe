// How cloth is carried along by a surface that moves beneath it.
#include "solvers/cloth/advance/carry_field.h"

#include <gtest/gtest.h>

#include "baker/core/parallel.h"
#include "tests/collision/grid.h"
#include "tests/support/numbered_pairs.h"

namespace ft {
namespace {

constexpr int k_side = 9;          ///< vertices along the cloth
constexpr double k_cell = 0.01;    ///< m
constexpr double k_height = 2e-3;  ///< of the cloth over the body [m]

/// A flat piece of cloth over one large triangle of body that moves by `motion` at every corner.
std::vector<Vec3> carried(const Vec3& motion, const Vec3& inertia_of_all, int threads = 1) {
  const ThreadLimit limit(threads);
  const int n = k_side * k_side;
  std::vector<Vec3> x;
  for (int i = 0; i < k_side; ++i)
    for (int j = 0; j < k_side; ++j) x.emplace_back(k_cell * i, k_height, k_cell * j);
  for (const Vec3& corner : {Vec3(-1, 0, -1), Vec3(-1, 0, 3), Vec3(3, 0, -1)}) x.push_back(corner);
  std::vector<Triangle> triangles;
  test::add_grid_triangles(k_side, 0, triangles);
  const Adjacency neighbours = vertex_neighbours(at(n), unique_edges(triangles));
  ContactPairs pairs;
  for (int v = 0; v < n; ++v) pairs.vertex_face.push_back({{v, n, n + 1, n + 2}});
  const std::vector<Vec3> body_motion(3, motion), inertia(at(n), inertia_of_all);
  const std::vector<int> part(3, 0);
  CarryInput in;
  in.cloth_vertex_count = n;
  in.x = x;
  in.body_motion = body_motion;
  in.inertia = inertia;
  in.neighbours = &neighbours;
  const test::NumberedPairs numbered(pairs);
  in.pairs = &numbered.list;
  in.part_of_body_vertex = part;
  in.range = 6e-3 + motion.norm();
  std::vector<Vec3> carry(at(n));
  carry_field(in, carry);
  return carry;
}

TEST(CarryField, A_surface_that_comes_takes_the_cloth_along) {
  // Every vertex sees the same: (w + g) c = w u, with w = 1/d^2 - g, hence c = (1 - d^2 / R^2) u.
  const double range = 6e-3 + 4e-3;
  for (const double way : {4e-3, -4e-3})
    for (const Vec3& c : carried({0, way, 0}, Vec3::Zero())) {
      EXPECT_NEAR(c.y(), (1 - k_height * k_height / (range * range)) * way, 0.02 * std::abs(way));
      EXPECT_NEAR(c.x(), 0, 1e-9);
      EXPECT_NEAR(c.z(), 0, 1e-9);
    }
}

TEST(CarryField, A_surface_that_glides_past_leaves_the_cloth_its_own_motion) {
  const Vec3 own(1e-3, 0, 5e-4);
  for (const Vec3& c : carried({4e-3, 0, 0}, own)) EXPECT_LT((c - own).norm(), 1e-9);
}

TEST(CarryField, Nothing_is_carried_farther_than_a_fifth_beyond_the_fastest) {
  for (const Vec3& c : carried({0, 3e-3, 0}, {0, -2e-3, 1e-3})) EXPECT_LE(c.norm(), 1.2 * 3e-3 + 1e-12);
}

TEST(CarryField, Is_the_same_to_the_bit_for_any_number_of_threads) {
  const std::vector<Vec3> one = carried({1e-3, 3e-3, 0}, {0, -2e-3, 1e-3}, 1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(one, carried({1e-3, 3e-3, 0}, {0, -2e-3, 1e-3}, threads));
}

}  // namespace
}  // namespace ft

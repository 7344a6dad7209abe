// Refinement: short edges, no cracks, a fixed linear map of the drawn vertices.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "baker/core/random.h"
#include "capsule_scene.h"
#include "collision/geometry/mesh_refine.h"

namespace ft {
namespace {

std::vector<Vec3> refined(const RefinedMesh& mesh, std::span<const Vec3> x) {
  std::vector<Vec3> out(at(mesh.vertex_count()));
  mesh.positions(x, out);
  return out;
}

double longest_edge(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  double longest = 0;
  for (const Edge& e : unique_edges(triangles)) longest = std::max(longest, (x[at(e[0])] - x[at(e[1])]).norm());
  return longest;
}

double area(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += triangle_area(x[at(t[0])], x[at(t[1])], x[at(t[2])]);
  return sum;
}

TEST(Refine, No_edge_stays_longer_than_asked_and_a_closed_surface_stays_closed) {
  for (const double max_edge : {0.005, 0.01, 0.03, 0.1, 1.0}) {
    const test::Shape s = test::capsule({0, 0, 0}, {0.1, 0.47, 0}, 0.085);
    const RefinedMesh mesh = refine_mesh(s.positions, s.triangles, max_edge);
    const auto x = refined(mesh, s.positions);
    EXPECT_LE(longest_edge(x, mesh.triangles), max_edge * (1 + 1e-8));
    std::map<std::array<int, 2>, int> directed;
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : directed) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(directed.contains({edge[1], edge[0]}));
    }
    EXPECT_NEAR(area(x, mesh.triangles), area(s.positions, s.triangles), 1e-12);
  }
}

TEST(Refine, Pieces_lie_in_the_triangle_that_they_came_from) {
  const test::Shape s = test::capsule({0, 0, 0}, {0.1, 0.47, 0}, 0.085, 9, 3);
  const RefinedMesh mesh = refine_mesh(s.positions, s.triangles, 0.02);
  const auto x = refined(mesh, s.positions);
  std::vector<double> sum(s.triangles.size(), 0.0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle &t = mesh.triangles[i], &whole = s.triangles[at(mesh.source[i])];
    sum[at(mesh.source[i])] += triangle_area(x[at(t[0])], x[at(t[1])], x[at(t[2])]);
    const Vec3 n = (x[at(whole[1])] - x[at(whole[0])]).cross(x[at(whole[2])] - x[at(whole[0])]).normalized();
    const Vec3 m = (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).normalized();
    EXPECT_GT(n.dot(m), 0.999);
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const Triangle& t = s.triangles[i];
    EXPECT_NEAR(sum[i], triangle_area(x[at(t[0])], x[at(t[1])], x[at(t[2])]), 1e-12);
  }
}

TEST(Refine, Is_a_linear_map_that_keeps_the_drawn_vertices) {
  const test::Shape s = test::capsule({0, 0, 0}, {0.1, 0.47, 0}, 0.085);
  const RefinedMesh mesh = refine_mesh(s.positions, s.triangles, 0.03);
  std::vector<Vec3> y, both;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    y.push_back({random_uniform({1, 2, 3, i}, 0), random_uniform({1, 2, 3, i}, 1), random_uniform({1, 2, 3, i}, 2)});
    both.push_back(2 * s.positions[i] - 3 * y[i]);
  }
  const auto a = refined(mesh, s.positions), b = refined(mesh, y), c = refined(mesh, both);
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_LT((c[i] - (2 * a[i] - 3 * b[i])).norm(), 1e-14);
  for (std::size_t i = 0; i < s.positions.size(); ++i) EXPECT_EQ(b[i], y[i]);
}

TEST(Refine, An_edge_of_17_lengths_becomes_17_pieces) {
  const std::vector<Vec3> x{{0, 0, 0}, {1.7, 0, 0}, {0.85, 0.01, 0}};
  const std::vector<Triangle> t{{0, 1, 2}};
  const RefinedMesh mesh = refine_mesh(x, t, 0.1);
  const auto y = refined(mesh, x);
  EXPECT_EQ(std::count_if(y.begin(), y.end(), [](const Vec3& p) { return p.y() == 0; }), 18);
}

TEST(Refine, Stops_before_it_would_make_too_many_triangles) {
  const std::vector<Vec3> x{{0, 0, 0}, {100, 0, 0}, {0, 100, 0}};
  const std::vector<Triangle> t{{0, 1, 2}};
  const RefinedMesh mesh = refine_mesh(x, t, 1e-3, 10'000);
  EXPECT_LE(mesh.triangles.size(), 10'000u);
  EXPECT_GT(mesh.triangles.size(), 1'000u);
}

TEST(Refine, Triangles_without_area_do_no_harm) {
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0, 0, 0}};
  const std::vector<Triangle> t{{0, 1, 2}, {0, 0, 1}, {0, 3, 1}, {2, 2, 2}};
  const RefinedMesh mesh = refine_mesh(x, t, 0.1);
  EXPECT_LE(longest_edge(refined(mesh, x), mesh.triangles), 0.1 * (1 + 1e-8));
  EXPECT_TRUE(all_finite(refined(mesh, x)));
}

}  // namespace
}  // namespace ft

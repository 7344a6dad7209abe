// Penetration depths: inside against the winding number by solid angles, depth against all triangles, holes.
#include "collision/check/penetration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "capsule_scene.h"
#include "collision/geometry/triangle_tree.h"
#include "collision/geometry/winding_number.h"
#include "open_body.h"
#include "tests/collision/grid.h"

namespace ft {
namespace {

std::vector<Vec3> cloud(std::uint64_t seed, int count, double size) {
  std::vector<Vec3> out;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    const auto r = [&](std::uint64_t k) { return size * (2 * random_uniform({seed, 0, 0, i}, k) - 1); };
    out.push_back({r(0), r(1), r(2)});
  }
  return out;
}

double slow_distance(const Vec3& p, std::span<const Vec3> x, std::span<const Triangle> triangles) {
  double best = 1e300;
  for (const Triangle& t : triangles)
    best = std::min(best, closest_on_triangle(p, x[at(t[0])], x[at(t[1])], x[at(t[2])]).squared_distance);
  return std::sqrt(best);
}

/// Two capsules that overlap: the union, whose inner walls count as surface for the depth.
test::Shape two_capsules() {
  test::Shape s = test::capsule({-0.2, 0, 0}, {0.2, 0.05, 0}, 0.1);
  const test::Shape other = test::capsule({0, -0.2, 0.03}, {0.02, 0.3, 0}, 0.07);
  const int first = static_cast<int>(s.positions.size());
  s.positions.insert(s.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles) s.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return s;
}

TEST(Penetration, Inside_and_depth_agree_with_solid_angles_and_all_triangles) {
  const test::Shape s = two_capsules();
  const auto points = cloud(5, 1500, 0.35);
  std::map<int, double> found;
  for (const Penetration& p : penetrations(points, s.positions, s.triangles)) found[p.vertex] = p.depth;
  int inside = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool expected = winding_number(points[at(i)], s.positions, s.triangles) > 0.5;
    ASSERT_EQ(found.contains(i), expected) << i;
    if (!expected) continue;
    ++inside;
    ASSERT_NEAR(found[i], slow_distance(points[at(i)], s.positions, s.triangles), 1e-14);
  }
  EXPECT_GT(inside, 50);
}

TEST(Penetration, Crossings_of_a_mesh_tell_the_same_as_asking_every_point) {
  test::Shape body = two_capsules();
  // A sheet through both, one beside them, one wholly inside.
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  for (const Vec3& centre : {Vec3(0.01, 0.02, 0), Vec3(0, 0.5, 0.3), Vec3(0.1, 0.02, 0)}) {
    const double side = centre.x() == 0.1 ? 0.05 : 0.5;
    const int n = 24, start = static_cast<int>(x.size());
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double u = i / (n - 1.0) - 0.5, v = j / (n - 1.0) - 0.5;
        x.push_back(centre + side * Vec3(u, 0.3 * std::sin(9 * u + 5 * v), v));
      }
    test::add_grid_triangles(n, start, triangles);
  }
  CheckedSurface sheets(triangles);
  sheets.move(x);
  const std::vector<Edge> edges = unique_edges(triangles);
  for (const bool open : {false, true}) {
    if (open) body.triangles.pop_back();
    CheckedSurface surface(body.triangles);
    surface.move(body.positions);
    EXPECT_EQ(surface.closed(), !open);
    const auto all = penetrations(x, surface);
    const auto told = penetrations(x, edges, crossings_between(sheets, surface), surface);
    ASSERT_EQ(told.size(), all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_EQ(told[k].vertex, all[k].vertex);
      EXPECT_EQ(told[k].depth, all[k].depth);
    }
    EXPECT_GT(all.size(), 650u);
    EXPECT_LT(all.size(), x.size() - 650u);
  }
}

TEST(Penetration, Missing_triangles_do_not_open_the_body) {
  test::Shape s = test::capsule({-0.2, 0, 0}, {0.2, 0, 0}, 0.1, 32, 12);
  const auto points = cloud(6, 800, 0.12);
  std::vector<int> expected;
  for (const Penetration& p : penetrations(points, s.positions, s.triangles)) expected.push_back(p.vertex);
  // One cap's tip is missing, as where a neck was cut off: 8 degrees wide.
  s.triangles.erase(s.triangles.begin(), s.triangles.begin() + 32);
  std::vector<int> found;
  for (const Penetration& p : penetrations(points, s.positions, s.triangles)) found.push_back(p.vertex);
  EXPECT_GT(expected.size(), 200u);
  EXPECT_EQ(found, expected);
}

TEST(Penetration, Cloth_that_hangs_free_of_open_shells_is_not_inside_them) {
  const test::Shape s = test::body_of_open_shells();
  std::vector<Vec3> points = cloud(12, 6000, 0.6);
  for (Vec3& p : points) p.y() += 0.5;
  points.push_back({0.13, 0.5, 0.1});   // under the dome's rim, beside the trunk: rays upwards end in the dome
  points.push_back({0.02, 0.6, 0.19});  // behind the card
  points.push_back({0.3, 0.05, 0});     // under the tube, whose walls most rays leave through
  std::map<int, double> found;
  for (const Penetration& p : penetrations(points, s.positions, s.triangles)) found[p.vertex] = p.depth;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const double w = std::abs(winding_number(points[at(i)], s.positions, s.triangles));
    if (std::abs(w - 0.5) < 1e-9) continue;
    ASSERT_EQ(found.contains(i), w > 0.5 && slow_distance(points[at(i)], s.positions, s.triangles) > 1e-5) << i;
  }
  EXPECT_GT(found.size(), 150u);
}

TEST(Penetration, A_closed_body_that_is_inside_out_has_the_same_inside) {
  test::Shape s = test::capsule({0, 0, 0}, {0, 0, 0.2}, 0.1);
  const auto points = cloud(13, 1000, 0.2);
  const auto expected = penetrations(points, s.positions, s.triangles);
  for (Triangle& t : s.triangles) std::swap(t[1], t[2]);
  const auto found = penetrations(points, s.positions, s.triangles);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k].vertex, expected[k].vertex);
}

TEST(Penetration, Depth_in_a_fine_sphere_is_radius_minus_distance) {
  const test::Shape s = test::capsule({0, 0, 0}, {0, 0, 1e-12}, 1.0, 128, 64);
  for (const double r : {0.0, 0.1, 0.5, 0.9, 0.99}) {
    const std::vector<Vec3> points{r * Vec3(0.3, -0.5, 0.81).normalized()};
    const auto found = penetrations(points, s.positions, s.triangles);
    ASSERT_EQ(found.size(), 1u) << r;
    EXPECT_NEAR(found[0].depth, 1 - r, 1e-3)
        << r;  // facets of 49 mm lie 0.3 mm inside the sphere, twice that at corners
  }
  const std::vector<Vec3> outside{{0, 0, 1.001}, {2, 0, 0}, {0.8, 0.8, 0}};
  EXPECT_TRUE(penetrations(outside, s.positions, s.triangles).empty());
}

TEST(Penetration, Points_on_the_surface_and_empty_inputs_do_not_count) {
  const test::Shape s = test::capsule({0, 0, 0}, {0, 0, 0.2}, 0.1);
  EXPECT_TRUE(penetrations(s.positions, s.positions, s.triangles).empty());
  EXPECT_TRUE(penetrations({}, s.positions, s.triangles).empty());
  EXPECT_TRUE(penetrations(s.positions, {}, {}).empty());
  const std::vector<Vec3> shallow{{0, 0, -0.0995}};
  EXPECT_EQ(penetrations(shallow, s.positions, s.triangles).size(), 1u);
  EXPECT_TRUE(penetrations(shallow, s.positions, s.triangles, 1e-3).empty());
}

TEST(Penetration, Is_the_same_for_any_number_of_threads) {
  const test::Shape s = test::capsule({0, 0, 0}, {0, 0, 0.2}, 0.1);
  const auto points = cloud(7, 2000, 0.2);
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    results.emplace_back();
    for (const Penetration& p : penetrations(points, s.positions, s.triangles))
      results.back().insert(results.back().end(), {double(p.vertex), p.depth});
    EXPECT_EQ(results.back(), results.front());
  }
  EXPECT_GT(results[0].size(), 100u);
}

TEST(TriangleTree, Closest_point_agrees_with_all_triangles_after_a_refit) {
  test::Shape s = test::capsule({-0.2, 0, 0}, {0.2, 0.05, 0}, 0.1);
  TriangleTree tree(s.positions, s.triangles);
  for (Vec3& p : s.positions) p = Vec3(p.x() + 0.3 * p.y() * p.y(), 1.4 * p.y(), p.z() - 0.2 * p.x());
  tree.refit(s.positions, s.triangles);
  for (const Vec3& p : cloud(8, 500, 0.5)) {
    TriangleTree::Hit hit;
    tree.closest(p, s.positions, s.triangles, hit);
    ASSERT_EQ(std::sqrt(hit.closest.squared_distance), slow_distance(p, s.positions, s.triangles));
    TriangleTree::Hit near;
    near.closest.squared_distance = 0.01;
    tree.closest(p, s.positions, s.triangles, near);
    ASSERT_EQ(near.triangle >= 0, hit.closest.squared_distance < 0.01);
  }
}

TEST(TriangleTree, A_refit_makes_the_same_boxes_again_after_they_were_forgotten) {
  test::Shape s = test::capsule({-0.2, 0, 0}, {0.2, 0.05, 0}, 0.1);
  TriangleTree kept(s.positions, s.triangles), forgetful(s.positions, s.triangles);
  for (Vec3& p : s.positions) p = Vec3(p.x() + 0.3 * p.y() * p.y(), 1.4 * p.y(), p.z() - 0.2 * p.x());
  forgetful.forget_boxes();
  EXPECT_TRUE(forgetful.nodes().empty());
  EXPECT_FALSE(forgetful.empty());
  for (TriangleTree* tree : {&kept, &forgetful}) tree->refit(s.positions, s.triangles);
  ASSERT_EQ(kept.nodes().size(), forgetful.nodes().size());
  for (std::size_t n = 0; n < kept.nodes().size(); ++n) {
    const TriangleTree::Node &a = kept.nodes()[n], &b = forgetful.nodes()[n];
    EXPECT_TRUE(a.first == b.first && a.count == b.count);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(a.box.lo[k] == b.box.lo[k] && a.box.hi[k] == b.box.hi[k]);
  }
  for (const Vec3& p : cloud(8, 100, 0.5)) {
    TriangleTree::Hit hit;
    forgetful.closest(p, s.positions, s.triangles, hit);
    EXPECT_EQ(std::sqrt(hit.closest.squared_distance), slow_distance(p, s.positions, s.triangles));
  }
}

TEST(TriangleTree, Closest_on_a_triangle_agrees_with_sampling_even_when_it_has_no_area) {
  const auto x = cloud(9, 900, 1.0);
  for (std::size_t i = 0; i + 3 < x.size(); i += 4) {
    Vec3 a = x[i], b = x[i + 1], c = x[i + 2];
    const Vec3& p = x[i + 3];
    const std::size_t kind = i / 4 % 4;
    if (kind == 1) c = a + 0.3 * (b - a);  // in line
    if (kind == 2) c = b;
    if (kind == 3) b = c = a;
    const ClosestOnTriangle found = closest_on_triangle(p, a, b, c);
    double sampled = 1e300;
    for (int u = 0; u <= 60; ++u)
      for (int v = 0; u + v <= 60; ++v)
        sampled = std::min(sampled, (p - (a + u / 60.0 * (b - a) + v / 60.0 * (c - a))).norm());
    const double distance = std::sqrt(found.squared_distance);
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_GE(distance, sampled - 0.06);  // samples are at most 3.5 / 60 apart
    EXPECT_NEAR((p - found.point).norm(), distance, 1e-12);
    const Vec3 features[7] = {a, b, c, a, b, c, a};
    if (found.feature < 3) {
      EXPECT_EQ(found.point, features[found.feature]);
    }
  }
}

}  // namespace
}  // namespace ft

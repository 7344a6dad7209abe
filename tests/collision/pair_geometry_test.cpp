// Closest points against a slow solution that shares nothing with the fast one: the quadratic program solved by
// enumerating every active set with a pivoted long double solve, and the optimality conditions of the answer itself.
#include "collision/geometry/pair_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "tests/collision/pair_scene.h"

namespace ft {
namespace {

using test::Dice;
using test::random_stencil;
using Wide3 = Eigen::Matrix<long double, 3, 1>;

/// Nearest point of the affine hull of some points to the origin, if it lies in their convex hull; else nothing.
/// The Minkowski difference of the two features is the convex hull of up to four differences; for edge-edge a
/// parallelogram.
long double hull_distance(const std::vector<Wide3>& points) {
  long double best = 1e300L;
  for (const Wide3& p : points) best = std::min(best, p.norm());
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Wide3 e = points[j] - points[i];
      const long double ee = e.squaredNorm();
      if (!(ee > 0)) continue;
      const long double t = std::clamp(-points[i].dot(e) / ee, 0.0L, 1.0L);
      best = std::min(best, (points[i] + t * e).norm());
      for (std::size_t k = j + 1; k < n; ++k) {
        Eigen::Matrix<long double, 3, 2> a;
        a << e, points[k] - points[i];
        const Eigen::Matrix<long double, 2, 1> w = a.colPivHouseholderQr().solve(-points[i]);
        if (w[0] < 0 || w[1] < 0 || w[0] + w[1] > 1) continue;
        best = std::min(best, (points[i] + a * w).norm());
      }
    }
  }
  return best;
}

long double slow_distance(PairKind kind, const std::array<Vec3, 4>& x) {
  std::vector<Wide3> difference;
  const auto wide = [&](std::size_t i) -> Wide3 { return x[i].cast<long double>(); };
  if (kind == PairKind::k_vertex_face) {
    for (std::size_t j = 1; j < 4; ++j) difference.push_back(wide(0) - wide(j));
  } else {
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 2; j < 4; ++j) difference.push_back(wide(i) - wide(j));
  }
  return hull_distance(difference);
}

void expect_consistent(PairKind kind, const std::array<Vec3, 4>& x, const PairGeometry& g, double scale) {
  const double rounding = 1e-14 * scale;  // a few dozen roundings of numbers of this size
  Vec3 offset = Vec3::Zero();
  double first = 0, second = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool of_first = static_cast<int>(i) < first_feature_size(kind);
    offset += g.weight[i] * x[i];
    (of_first ? first : second) += g.weight[i];
    EXPECT_TRUE(of_first ? g.weight[i] >= 0 : g.weight[i] <= 0) << "weight " << i << " = " << g.weight[i];
  }
  EXPECT_NEAR(first, 1, 1e-14);
  EXPECT_NEAR(second, -1, 1e-14);
  EXPECT_NEAR((offset - g.distance * g.normal).norm(), 0,
              1e3 * rounding);  // interior feet of slim features: 1 / sin(angle)
  if (g.distance > 0) {
    EXPECT_NEAR(g.normal.norm(), 1, 1e-14);
  } else {
    EXPECT_EQ(g.normal, Vec3::Zero());
  }
}

void compare_with_slow(PairKind kind, std::uint64_t seed) {
  Dice dice(seed);
  for (int trial = 0; trial < 40000; ++trial) {
    const double scale = std::pow(10, dice.below(5) - 3);
    const std::array<Vec3, 4> x = random_stencil(dice, scale);
    const PairGeometry g = pair_geometry(kind, x);
    expect_consistent(kind, x, g, 3 * scale);
    ASSERT_NEAR(g.distance, static_cast<double>(slow_distance(kind, x)), 3e-14 * scale) << "trial " << trial;
    // The plane through the closest points supports both features: the condition of optimality, seen from the answer.
    // Where features (nearly) touch the direction is only as good as rounding / distance.
    if (g.distance > 1e-7 * scale) {
      ASSERT_NEAR(separation(kind, x, g), g.distance, 1e-7 * scale) << "trial " << trial;
    }
    if (::testing::Test::HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(PairGeometry, Vertex_face_distance_is_that_of_the_slow_solution) {
  compare_with_slow(PairKind::k_vertex_face, 1);
}
TEST(PairGeometry, Edge_edge_distance_is_that_of_the_slow_solution) {
  compare_with_slow(PairKind::k_edge_edge, 2);
}

TEST(PairGeometry, A_vertex_above_the_middle_of_a_face_has_the_face_normal_and_thirds) {
  const Vec3 a(0, 0, 0), b(3, 0, 0), c(0, 3, 0);
  for (const double height : {2.0, 1e-6, 1e-12, -1e-12, -2.0}) {
    const PairGeometry g = vertex_face_geometry({1, 1, height}, a, b, c);
    EXPECT_TRUE(g.interior);
    EXPECT_DOUBLE_EQ(g.distance, std::abs(height));
    EXPECT_EQ(g.normal, Vec3(0, 0, height > 0 ? 1 : -1));
    for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(g.weight[i], -1.0 / 3, 1e-15);
  }
  const PairGeometry touching = vertex_face_geometry({1, 1, 0}, a, b, c);
  EXPECT_EQ(touching.distance, 0);
  EXPECT_EQ(touching.normal, Vec3::Zero());
}

TEST(PairGeometry, Crossed_edges_meet_at_their_middles) {
  for (const double height : {2.0, 1e-12, -1e-12}) {
    const PairGeometry g = edge_edge_geometry({-1, 0, height}, {1, 0, height}, {0, -1, 0}, {0, 1, 0});
    EXPECT_TRUE(g.interior);
    EXPECT_DOUBLE_EQ(g.distance, std::abs(height));
    EXPECT_EQ(g.normal, Vec3(0, 0, height > 0 ? 1 : -1));
    for (const double w : g.weight) EXPECT_DOUBLE_EQ(std::abs(w), 0.5);
  }
}

TEST(PairGeometry, Parallel_edges_are_as_far_apart_as_their_lines_where_they_overlap_and_as_their_ends_elsewhere) {
  for (const double turn : {0.0, 1e-12, -1e-12}) {
    for (const double shift : {-3.0, -1.0, -0.5, 0.0, 0.25, 1.0, 2.5}) {
      const double beside = std::max({0.0, shift - 1, -1 - shift});
      const PairGeometry g = edge_edge_geometry({0, 0, 0}, {1, 0, 0}, {shift, 0.5, 0}, {shift + 1, 0.5 + turn, 0});
      EXPECT_NEAR(g.distance, std::hypot(0.5, beside), 2e-12);
      EXPECT_NEAR(g.normal.y(), -0.5 / std::hypot(0.5, beside), 2e-12);
    }
  }
}

TEST(PairGeometry, Features_without_size_are_points) {
  for (const double size : {0.0, 1e-12, -1e-12}) {
    const Vec3 d(size, -size, 2 * size);
    const PairGeometry edges = edge_edge_geometry({0, 0, 1}, Vec3(0, 0, 1) + d, {0, 0, 0}, d);
    EXPECT_NEAR(edges.distance, 1, 4e-12);
    const PairGeometry point_of_edge = edge_edge_geometry({0.5, 0, 1}, Vec3(0.5, 0, 1) + d, {0, 0, 0}, {1, 0, 0});
    EXPECT_NEAR(point_of_edge.distance, 1, 4e-12);
    EXPECT_NEAR(point_of_edge.weight[3], -0.5, 4e-12);
    const PairGeometry face = vertex_face_geometry({0, 0, 1}, {0, 0, 0}, d, 2 * d);
    EXPECT_NEAR(face.distance, 1, 5e-12);
    const PairGeometry line = vertex_face_geometry({0.25, 0, 1}, {0, 0, 0}, {1, 0, 0}, Vec3(0.5, 0, 0) + d);
    EXPECT_NEAR(line.distance, 1, 4e-12);
  }
}

TEST(PairGeometry, A_pair_that_moves_as_a_whole_keeps_its_distance) {
  Dice dice(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const std::array<Vec3, 4> x = random_stencil(dice, 0.1);
    std::array<Vec3, 4> moved = x;
    const Vec3 by = dice.cube(1).array().round();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(dice.uniform(0, 3), dice.direction()));
    for (Vec3& p : moved) p = turn * p + by;
    for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge})
      EXPECT_NEAR(pair_geometry(kind, x).distance, pair_geometry(kind, moved).distance, 5e-15);
  }
}

TEST(PairGeometry, Separation_never_exceeds_the_true_distance_whatever_the_normal) {
  Dice dice(8);
  for (int trial = 0; trial < 20000; ++trial) {
    const std::array<Vec3, 4> x = random_stencil(dice, 1);
    for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge}) {
      PairGeometry any;
      any.normal = dice.direction();
      EXPECT_LE(separation(kind, x, any), static_cast<double>(slow_distance(kind, x)) + 1e-14);
    }
  }
}

TEST(PairGeometry, The_gap_of_boxes_never_exceeds_the_true_distance) {
  Dice dice(9);
  for (int trial = 0; trial < 20000; ++trial) {
    std::array<Vec3, 4> x = random_stencil(dice, 1);
    for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge}) {
      for (int k = 0; k < first_feature_size(kind); ++k) x[at(k)] += 3 * dice.direction();
      EXPECT_LE(std::sqrt(box_gap_squared(kind, x)), static_cast<double>(slow_distance(kind, x)) + 1e-14);
    }
  }
}

}  // namespace
}  // namespace ft

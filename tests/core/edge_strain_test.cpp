#include "baker/core/edge_strain.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ft {
namespace {

TEST(Edge_strain, Edge_without_length_is_left_out) {
  const std::vector<Vec3> rest = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
  const RestEdges edges = rest_edges(rest, triangles);
  EXPECT_EQ(edges.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {0, 3}, {2, 3}}));
  EXPECT_EQ(edges.lengths, (std::vector<double>{1, 1, 2, std::sqrt(5.0)}));
}

TEST(Edge_strain, Twice_the_size_is_a_strain_of_one_everywhere_and_half_of_minus_a_half) {
  const std::vector<Vec3> rest = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  const std::vector<Triangle> triangle = {{0, 1, 2}};
  const RestEdges edges = rest_edges(rest, triangle);
  for (const double size : {1.0, 2.0, 0.5}) {
    std::vector<Vec3> x = rest;
    for (Vec3& p : x) p *= size;
    EXPECT_EQ(edge_strains(edges, x), std::vector<double>(3, size - 1));
  }
}

TEST(Edge_strain, Summary_is_mean_99th_of_a_hundred_and_largest) {
  std::vector<double> strains;
  for (int i = 199; i >= 0; --i) strains.push_back(i);
  const StrainSummary s = summary(strains);
  EXPECT_EQ(s.mean, 99.5);
  EXPECT_EQ(s.p99, 198);
  EXPECT_EQ(s.max, 199);
  const StrainSummary negative = summary({-0.5, -0.25});
  EXPECT_EQ(negative.max, -0.25);
  const StrainSummary none = summary({});
  EXPECT_EQ(none.mean, 0);
  EXPECT_EQ(none.p99, 0);
  EXPECT_EQ(none.max, 0);
}

}  // namespace
}  // namespace ft

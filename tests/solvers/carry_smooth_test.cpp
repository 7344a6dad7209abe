#include "solvers/cloth/model/carry_smooth.h"

#include <gtest/gtest.h>

#include "baker/core/random.h"

namespace ft {
namespace {

constexpr double k_typical = 0.02, k_tiny = 5e-4;

/// A row of vertices: ten 20 mm apart, then sixteen 0.5 mm apart, then ten 20 mm apart.
struct Row {
  std::vector<Vec3> rest{Vec3::Zero()};
  RestEdges edges;
  std::vector<double> typical;
  CarrySmooth smooth;

  explicit Row(double tiny = k_tiny) {
    for (int i = 0; i < 35; ++i) {
      const double length = i >= 10 && i < 25 ? tiny : k_typical;
      rest.push_back(rest.back() + Vec3(length, 0, 0));
      edges.edges.push_back({i, i + 1});
      edges.lengths.push_back(length);
    }
    typical.assign(rest.size(), k_typical);
    smooth = CarrySmooth(rest, edges, typical, 1.0 / 16, {});
  }
};

std::vector<Vec3> noise(std::size_t count) {
  std::vector<Vec3> out;
  for (std::uint64_t i = 0; i < count; ++i)
    out.emplace_back(random_uniform({1, 0, 0, 3 * i}), random_uniform({1, 0, 0, 3 * i + 1}),
                     random_uniform({1, 0, 0, 3 * i + 2}));
  return out;
}

TEST(CarrySmooth, What_has_no_short_edges_is_carried_as_it_was) {
  const Row row(k_typical);
  EXPECT_TRUE(row.smooth.empty());
  std::vector<Vec3> carry = noise(row.rest.size());
  const std::vector<Vec3> before = carry;
  row.smooth.smooth(carry);
  EXPECT_EQ(carry, before);
  CarrySmooth::Walk walk;
  EXPECT_TRUE(row.smooth.along_with(3, walk).empty());
}

TEST(CarrySmooth, A_carry_that_is_common_stays_and_of_another_the_mean_does_nearly) {
  const Row row;
  std::vector<Vec3> common(row.rest.size(), Vec3(0.01, 0.02, -0.03));
  row.smooth.smooth(common);
  for (const Vec3& c : common) EXPECT_LT((c - Vec3(0.01, 0.02, -0.03)).norm(), 1e-15);
  std::vector<Vec3> carry = noise(row.rest.size());
  const auto sum = [&] {
    Vec3 out = Vec3::Zero();
    for (const Vec3& c : carry) out += c;
    return out;
  };
  const Vec3 before = sum();
  row.smooth.smooth(carry);
  EXPECT_LT((sum() - before).norm(), 0.03 * 16);  // the links act and react, as far as they are solved for
}

TEST(CarrySmooth, Neighbours_at_short_edges_part_by_a_small_share_of_what_they_did_and_the_others_as_they_did) {
  const Row row;
  std::vector<Vec3> carry = noise(row.rest.size());
  for (Vec3& c : carry) c *= 0.02;
  const std::vector<Vec3> before = carry;
  row.smooth.smooth(carry);
  for (std::size_t k = 10; k < 25; ++k) EXPECT_LT((carry[k + 1] - carry[k]).norm(), 0.1 * k_tiny) << k;
  for (std::size_t v = 0; v < carry.size(); ++v) {
    if (v < 10 || v > 25) {
      EXPECT_EQ(carry[v], before[v]) << v;
    }
  }
}

TEST(CarrySmooth, What_is_moved_out_of_a_way_takes_the_near_along_by_their_distance) {
  const Row row;
  CarrySmooth::Walk walk;
  double last = 1;
  int count = 0;
  for (const CarrySmooth::Share& s : row.smooth.along_with(12, walk)) {
    const double distance = (row.rest[at(s.vertex)] - row.rest[12]).norm();
    if (s.vertex == 12) {
      EXPECT_EQ(s.weight, 1);
    }
    EXPECT_NEAR(s.weight, 1 - distance / k_typical, 1e-12);
    EXPECT_LE(s.weight, last + 2 * k_tiny / k_typical);  // breadth first, from both sides
    last = s.weight;
    ++count;
  }
  EXPECT_EQ(count, 16);
  EXPECT_EQ(row.smooth.along_with(25, walk).size(), 16u);  // the walk may be used again
}

TEST(CarrySmooth, A_cluster_comes_along_all_the_way) {
  const Row row;
  const std::vector<double> size(row.rest.size(), 1.1 * k_tiny);
  const VertexClusters clusters(row.edges, size);
  ASSERT_GT(clusters.count(), 0);
  const CarrySmooth smooth(row.rest, row.edges, row.typical, 1.0 / 16, clusters);
  CarrySmooth::Walk walk;
  const int other = clusters.members(0)[1];
  for (const CarrySmooth::Share& s : smooth.along_with(clusters.members(0)[0], walk)) {
    if (s.vertex == other) {
      EXPECT_EQ(s.weight, 1);
    }
  }
}

}  // namespace
}  // namespace ft

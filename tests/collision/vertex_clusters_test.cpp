// Vertices that lie very near each other are found along the edges, and share values.
#include "collision/step_bound/vertex_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ft {
namespace {

std::vector<int> list(std::span<const int> numbers) {
  return {numbers.begin(), numbers.end()};
}

/// 0 -1mm- 1 -2mm- 2 -9mm- 3 -1mm- 4, and 5 for itself.
RestEdges chain() {
  return {{{0, 1}, {1, 2}, {2, 3}, {3, 4}}, {1e-3, 2e-3, 9e-3, 1e-3}};
}

TEST(VertexClusters, Join_what_short_edges_join) {
  const VertexClusters clusters(chain(), std::vector<double>(6, 4e-3));
  ASSERT_EQ(clusters.count(), 2);
  EXPECT_EQ(list(clusters.members(0)), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(list(clusters.members(1)), (std::vector<int>{3, 4}));
  EXPECT_EQ(clusters.of(2), 0);
  EXPECT_EQ(clusters.of(5), -1);
  EXPECT_EQ(clusters.of(1000), -1) << "a vertex of the body";
  EXPECT_EQ(list(clusters.with(4)), (std::vector<int>{3, 4}));
  EXPECT_EQ(list(clusters.with(5)), (std::vector<int>{5}));
}

TEST(VertexClusters, Grow_from_the_shortest_edge_and_no_longer_than_their_size) {
  RestEdges line;  // ten edges that are each short enough
  for (int i = 0; i < 10; ++i) line.edges.push_back({i, i + 1}), line.lengths.push_back(i == 4 ? 0.9e-3 : 1e-3);
  const VertexClusters clusters(line, std::vector<double>(11, 2e-3));
  EXPECT_EQ(clusters.of(4), clusters.of(5));
  for (int c = 0; c < clusters.count(); ++c) {
    EXPECT_GE(clusters.members(c).size(), 2u);
    EXPECT_LE(clusters.members(c).back() - clusters.members(c).front(), 2);
  }
  std::reverse(line.edges.begin(), line.edges.end() - 6);
  const VertexClusters same(line, std::vector<double>(11, 2e-3));
  EXPECT_EQ(same.of(4), same.of(5));
}

TEST(VertexClusters, Each_vertex_has_a_size_of_its_own_and_the_smaller_counts) {
  const VertexClusters clusters(chain(), std::vector<double>{1e-3, 1e-3, 9e-2, 9e-2, 0, 0});
  EXPECT_EQ(list(clusters.members(clusters.of(0))), (std::vector<int>{0, 1}));
  EXPECT_EQ(list(clusters.members(clusters.of(2))), (std::vector<int>{2, 3}));
  EXPECT_EQ(clusters.of(4), -1);
}

TEST(VertexClusters, None_are_found_in_a_mesh_of_equal_edges) {
  const VertexClusters clusters(chain(), std::vector<double>(6, 0.5e-3));
  EXPECT_TRUE(clusters.empty());
  EXPECT_EQ(clusters.count(), 0);
  EXPECT_EQ(list(clusters.with(3)), (std::vector<int>{3}));
  std::vector<double> values{3, 1, 2};
  clusters.take_least(values);
  EXPECT_EQ(values, (std::vector<double>{3, 1, 2}));
}

TEST(VertexClusters, Share_the_least_the_most_and_the_mean) {
  const VertexClusters clusters(chain(), std::vector<double>(6, 4e-3));
  std::vector<double> least{3, 1, 2, 8, 9, 7}, most = least;
  clusters.take_least(least);
  clusters.take_most(most);
  EXPECT_EQ(least, (std::vector<double>{1, 1, 1, 8, 8, 7}));
  EXPECT_EQ(most, (std::vector<double>{3, 3, 3, 9, 9, 7}));
  std::vector<Vec3> motion{{1, 0, 0}, {2, 0, 0}, {6, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}};
  clusters.take_mean(motion);
  EXPECT_EQ(motion[0], Vec3(3, 0, 0));
  EXPECT_EQ(motion[2], Vec3(3, 0, 0));
  EXPECT_EQ(motion[4], Vec3(0, 0.5, 0.5));
  EXPECT_EQ(motion[5], Vec3(5, 5, 5));
}

}  // namespace
}  // namespace ft

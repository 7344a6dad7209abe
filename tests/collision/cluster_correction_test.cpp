// What a pair's retreat moves of the clusters that its corners are in.
#include "collision/step_bound/cluster_correction.h"

#include <gtest/gtest.h>

#include <map>

namespace ft {
namespace {

using Moves = std::map<int, double>;

/// Vertices 0 to 2 are a cluster, 5 and 6 another; the others are alone.
Moves moves(PairKind kind, const Stencil& stencil, const std::array<double, 4>& along) {
  const RestEdges edges{{{0, 1}, {1, 2}, {5, 6}}, {1e-3, 1e-3, 1e-3}};
  const VertexClusters clusters(edges, std::vector<double>(10, 3e-3));
  Moves out;
  for_each_retreat(clusters, kind, stencil, along, [&](int v, double retreat) { out[v] += retreat; });
  return out;
}

TEST(ClusterCorrection, A_cluster_moves_with_its_corner_and_a_vertex_for_itself_alone) {
  EXPECT_EQ(moves(PairKind::k_vertex_face, {{1, 7, 8, 9}}, {3, -1, 0, -2}),
            (Moves{{0, 3}, {1, 3}, {2, 3}, {7, -1}, {9, -2}}));
}

TEST(ClusterCorrection, Corners_of_one_cluster_move_it_once_by_the_largest) {
  EXPECT_EQ(moves(PairKind::k_edge_edge, {{0, 2, 7, 8}}, {1, 3, -2, 0}), (Moves{{0, 3}, {1, 3}, {2, 3}, {7, -2}}));
  EXPECT_EQ(moves(PairKind::k_edge_edge, {{7, 8, 5, 6}}, {0, 0, -2, -2}), (Moves{{5, -2}, {6, -2}}));
}

TEST(ClusterCorrection, A_cluster_does_not_retreat_from_itself_as_one) {
  EXPECT_EQ(moves(PairKind::k_edge_edge, {{0, 7, 2, 8}}, {1, 2, -3, -4}), (Moves{{0, 1}, {7, 2}, {2, -3}, {8, -4}}));
}

TEST(ClusterCorrection, Vertices_of_the_body_are_in_no_cluster) {
  EXPECT_EQ(moves(PairKind::k_vertex_face, {{6, 100, 101, 102}}, {3, 0, -1, 0}), (Moves{{5, 3}, {6, 3}, {101, -1}}));
}

}  // namespace
}  // namespace ft

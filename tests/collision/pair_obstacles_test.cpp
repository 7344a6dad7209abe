// What is in the way of a displacement is what truncation cuts, and nothing else.
#include "collision/step_bound/pair_obstacles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "collision/step_bound/truncate_dat.h"
#include "tests/collision/pair_scene.h"

namespace ft {
namespace {

using test::Dice;

constexpr double k_floor = 1e-5;
constexpr double k_gap = 1e-3;  ///< m

/// A vertex above a face of 20 mm.
struct VertexOverFace {
  std::vector<Vec3> x{{0.2e-2, k_gap, 0.3e-2}, {0, 0, 0}, {0, 0, 2e-2}, {2e-2, 0, 0}};
  std::vector<Vec3> dx{4, Vec3::Zero()};
  ContactPairs pairs{{Stencil{{0, 1, 2, 3}}}, {}};

  std::vector<PairObstacle> found(int movable_count = 4) const {
    return find_obstacles(x, dx, movable_count, pairs, k_floor);
  }
};

/// Two edges that cross in their middles.
struct CrossedEdges {
  std::vector<Vec3> x{{-1e-2, k_gap, 0}, {1e-2, k_gap, 0}, {0, 0, -1e-2}, {0, 0, 1e-2}};
  std::vector<Vec3> dx{4, Vec3::Zero()};
  ContactPairs pairs{{}, {Stencil{{0, 1, 2, 3}}}};

  std::vector<PairObstacle> found() const { return find_obstacles(x, dx, 4, pairs, k_floor); }
};

TEST(PairObstacles, A_face_is_in_the_way_of_a_vertex_that_would_pass_it) {
  VertexOverFace s;
  s.dx[0] = Vec3(1e-4, -3 * k_gap, 0);
  const auto found = s.found();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].vertex, (std::array<int, 4>{0, 1, 2, 3}));
  EXPECT_NEAR(found[0].approach, 3 * k_gap, 1e-12);
  EXPECT_NEAR(found[0].allowed, k_truncate_reach * (k_gap - k_floor), 1e-12);
  EXPECT_LT((found[0].normal - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(found[0].weight[0], 1);
  EXPECT_NEAR(found[0].weight[1] + found[0].weight[2] + found[0].weight[3], -1, 1e-12);
  EXPECT_NEAR(found[0].weight[2], -0.15, 1e-12);  // of the closest point
}

TEST(PairObstacles, Nothing_is_in_the_way_of_what_keeps_apart) {
  VertexOverFace s;
  s.dx[0] = Vec3(0, -0.8 * k_gap, 0);
  EXPECT_TRUE(s.found().empty()) << "it stays in its room";
  s.dx[0] = Vec3(5e-3, 3 * k_gap, 0);
  EXPECT_TRUE(s.found().empty()) << "it goes away";
  std::fill(s.dx.begin(), s.dx.end(), Vec3(1e-3, -5 * k_gap, 2e-3));
  EXPECT_TRUE(s.found().empty()) << "they go together";
  EXPECT_EQ(s.found(1).size(), 1u) << "the face does not move";
}

TEST(PairObstacles, A_pair_that_is_nearer_than_the_floor_allows_no_less_than_it) {
  VertexOverFace s;
  s.x[0].y() = 0.5 * k_floor;
  s.dx[0] = Vec3(0, -k_gap, 0);
  ASSERT_EQ(s.found().size(), 1u);
  EXPECT_EQ(s.found()[0].allowed, k_floor);
}

TEST(PairObstacles, Of_an_edge_that_turns_it_is_the_end_that_comes_nearer) {
  CrossedEdges s;
  s.dx[0] = Vec3(0, -3 * k_gap, 0);
  s.dx[1] = Vec3(0, 3 * k_gap, 0);  // the middle stays where it is
  const auto found = s.found();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].weight[0], 1);
  EXPECT_EQ(found[0].weight[1], 0);
  EXPECT_EQ(found[0].weight[2] + found[0].weight[3], -1);
  EXPECT_NEAR(found[0].approach, 3 * k_gap, 1e-12);
}

/// Truncation knows more of what is in common, never less: pairs that are no obstacle are not cut.
TEST(PairObstacles, What_truncation_cuts_of_random_pairs_is_in_the_way) {
  Dice dice(7);
  int obstacles = 0, free = 0;
  for (int p = 0; p < 20000; ++p) {
    const PairKind kind = dice.below(2) == 0 ? PairKind::k_vertex_face : PairKind::k_edge_edge;
    const std::array<Vec3, 4> x = test::random_stencil(dice, 1);
    const PairRoom room = pair_room(kind, x);
    if (room.gap < 1e-3) continue;
    const double reach = std::pow(10, dice.uniform(-2.5, 1));
    std::vector<Vec3> places(x.begin(), x.end()), dx;
    for (int i = 0; i < 4; ++i) dx.push_back(dice.cube(reach));
    ContactPairs pairs;
    (kind == PairKind::k_vertex_face ? pairs.vertex_face : pairs.edge_edge).push_back({{0, 1, 2, 3}});
    const auto found = find_obstacles(places, dx, 4, pairs, k_floor);
    const std::vector<Vec3> still(4, Vec3::Zero());
    PairMove move = pair_move({{0, 1, 2, 3}}, places, dx, dx, 4);
    if (found.empty()) {
      // All of it may be had in common, as far as this pair is concerned: nothing is left to be cut.
      const auto share = truncate_pair(kind, move, k_floor);
      EXPECT_EQ(*std::min_element(share.begin(), share.end()), 1) << p;
      ++free;
    } else {
      EXPECT_GT(found[0].approach, found[0].allowed);
      move = pair_move({{0, 1, 2, 3}}, places, dx, still, 4);
      const auto share = truncate_pair(kind, move, k_floor);
      EXPECT_LT(*std::min_element(share.begin(), share.end()), 1) << p;
      ++obstacles;
    }
  }
  EXPECT_GT(obstacles, 1000);
  EXPECT_GT(free, 1000);
}

}  // namespace
}  // namespace ft

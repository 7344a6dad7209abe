// Nets, ropes and chains: their shape, what they weigh, how their cords run on into each other.
#include "tests/support/cords.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "solvers/cords/generators.h"

namespace ft {
namespace {

TEST(Cords, A_basketball_net_has_its_loops_sides_and_measures) {
  const CordGraph net = diamond_net({});
  EXPECT_EQ(net.points.size(), 7u * 12 + 6 * 24) << "knots, and a point within each side";
  EXPECT_EQ(net.cords.size(), 6u * 24 * 2);
  std::vector<int> rim(12);
  std::iota(rim.begin(), rim.end(), 0);
  EXPECT_EQ(net.held, rim);
  for (const int i : rim) {
    EXPECT_NEAR(net.points[at(i)].norm(), 0.225, 1e-15);
    EXPECT_EQ(net.points[at(i)].y(), 0);
  }
  const Box box = bounds(net.points);
  EXPECT_NEAR(box.lo.y(), -0.42, 1e-15);
  std::vector<int> cords_at(net.points.size(), 0);
  for (const Edge& cord : net.cords)
    for (const int i : cord) ++cords_at[at(i)];
  for (int i = 0; i < 84; ++i) EXPECT_EQ(cords_at[at(i)], i < 12 || i >= 72 ? 2 : 4) << i;
  for (int i = 84; i < std::ssize(cords_at); ++i) EXPECT_EQ(cords_at[at(i)], 2) << i;
}

TEST(Cords, A_net_looks_the_same_turned_by_one_loop_and_in_its_mirror) {
  for (const int rows : {1, 2, 5, 6}) {
    const CordGraph net = diamond_net({.columns = 7, .rows = rows, .pieces = 3});
    const auto find = [&](const Vec3& p) {
      for (std::size_t i = 0; i < net.points.size(); ++i)
        if ((net.points[i] - p).norm() < 1e-12) return static_cast<int>(i);
      return -1;
    };
    const std::set<Edge> cords(net.cords.begin(), net.cords.end());
    const Mat3 turn = Eigen::AngleAxisd(2 * std::numbers::pi / 7, Vec3::UnitY()).toRotationMatrix();
    const Mat3 mirror = Vec3(1, 1, -1).asDiagonal();
    for (const Mat3& symmetry : {turn, mirror})
      for (const auto& [a, b] : net.cords) {
        const int i = find(symmetry * net.points[at(a)]), j = find(symmetry * net.points[at(b)]);
        EXPECT_TRUE(cords.contains({std::min(i, j), std::max(i, j)})) << rows << ": " << a << " " << b;
      }
  }
}

TEST(Cords, A_nets_twines_run_from_the_rim_to_the_last_loops_on_smooth_diagonals) {
  const CordGraph net = diamond_net({});
  test::expect_strands_hold_every_cord(net);
  ASSERT_EQ(net.strands.size(), 24u) << "two from every loop";
  for (const auto& strand : net.strands) {
    EXPECT_EQ(strand.size(), 13u);
    EXPECT_LT(strand.front(), 12) << "a strand begins where it is held";
    for (std::size_t i = 1; i + 1 < strand.size(); ++i) EXPECT_GT(test::cosine_of_turn(net, strand, i), 0.9);
  }
}

TEST(Cords, A_rope_is_one_strand_that_begins_where_it_is_held) {
  RopeMeasures measures;
  measures.to = Vec3(1, 0, 0);
  measures.pieces = 8;
  for (const auto& [from, to] : {std::pair{true, false}, {false, true}, {true, true}, {false, false}}) {
    measures.hold_from = from, measures.hold_to = to;
    const CordGraph cord = rope(measures);
    test::expect_strands_hold_every_cord(cord);
    ASSERT_EQ(cord.strands.size(), 1u);
    EXPECT_EQ(cord.strands[0].front(), to && !from ? 8 : 0);
    EXPECT_EQ(cord.held.size(), std::size_t{from} + std::size_t{to});
    for (int i = 0; i <= 8; ++i) EXPECT_EQ(cord.points[at(i)], Vec3(i / 8.0, 0, 0));
  }
}

TEST(Cords, Points_weigh_half_of_their_cords_and_knots_what_they_weigh) {
  RopeMeasures measures;
  measures.to = Vec3(0, -3, 0);
  measures.pieces = 2;
  measures.knots = 3;
  measures.knot_share = 0.5;  // 0.2 kg each on a rope of 0.4 kg
  const CordGraph chain = rope(measures);
  const std::vector<double> masses = lumped_masses(chain, 1.0);
  const std::vector<double> expected = {0.4 / 12,      0.4 / 6, 0.4 / 6 + 0.2, 0.4 / 6,
                                        0.4 / 6 + 0.2, 0.4 / 6, 0.4 / 12 + 0.2};
  ASSERT_EQ(masses.size(), expected.size());
  for (std::size_t i = 0; i < masses.size(); ++i) EXPECT_NEAR(masses[i], expected[i], 1e-15) << i;

  const std::vector<double> net = lumped_masses(diamond_net({}), 0.03);
  EXPECT_NEAR(std::accumulate(net.begin(), net.end(), 0.0), 0.03, 1e-16);
}

TEST(Cords, Edges_of_a_mesh_are_cords_along_its_rows_and_columns_without_diagonals) {
  const Mesh mesh = test::grid_of_quads(4, 3);
  for (const int pieces : {1, 3}) {
    const auto net = cords_of_mesh(mesh, "top", pieces);
    ASSERT_TRUE(net.ok()) << net.error().text();
    EXPECT_EQ(net->cords.size(), at(pieces * (4 * 4 + 5 * 3)));
    test::expect_strands_hold_every_cord(*net);
    EXPECT_EQ(net->strands.size(), 4u + 5u) << "four rows and five columns";
    EXPECT_EQ(net->held, (std::vector<int>{0, 1, 2, 3, 4}));
    for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(net->points[i], mesh.positions[i]);
  }
}

TEST(Cords, A_ring_is_one_strand_that_ends_where_it_begins) {
  CordGraph ring;
  for (int i = 0; i < 12; ++i)
    ring.points.push_back(Vec3(std::cos(i * std::numbers::pi / 6), 0, std::sin(i * std::numbers::pi / 6)));
  for (int i = 0; i < 12; ++i) ring.cords.push_back({std::min(i, (i + 1) % 12), std::max(i, (i + 1) % 12)});
  join_strands(ring);
  test::expect_strands_hold_every_cord(ring);
  ASSERT_EQ(ring.strands.size(), 1u);
  EXPECT_EQ(ring.strands[0].front(), ring.strands[0].back());
}

TEST(Cords, Vertices_without_faces_and_with_no_weight_are_left_out) {
  Mesh mesh = test::grid_of_quads(1, 1);
  mesh.positions.insert(mesh.positions.begin() + 2, Vec3(9, 9, 9));
  for (int& v : mesh.face_vertices) v += v >= 2;
  mesh.groups = {{"some", {1, 2, 4}, {0.0, 1.0, 0.5}}};
  const auto net = cords_of_mesh(mesh, "some", 1);
  ASSERT_TRUE(net.ok()) << net.error().text();
  EXPECT_EQ(net->points.size(), 4u);
  EXPECT_EQ(net->held, std::vector<int>{3}) << "the mesh's vertex 4";
}

TEST(Cords, Meshes_that_make_no_cords_are_refused_with_the_reason) {
  Mesh mesh = test::grid_of_quads(1, 1);
  EXPECT_NE(cords_of_mesh(mesh, "rim", 1).error().text().find("no vertex group \"rim\" (there are: top)"),
            std::string::npos);
  EXPECT_NE(cords_of_mesh(mesh, "", 300'000).error().text().find("4 edges, each in 300000 pieces"), std::string::npos);
  mesh.positions[1] = mesh.positions[0];
  EXPECT_NE(cords_of_mesh(mesh, "", 1).error().text().find("vertices 0 and 1 has no length"), std::string::npos);
  EXPECT_FALSE(cords_of_mesh(Mesh{}, "", 1).ok());
}

}  // namespace
}  // namespace ft

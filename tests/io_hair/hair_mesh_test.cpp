// Middle lines of cards and tubes whose middles are known, and lines at even distances.
#include "io/hair/hair_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "io/hair/long_way.h"
#include "io/hair/resample.h"

namespace ft {
namespace {

using std::numbers::pi;

/// Quads between rows of vertices; round: the last of a row is joined to the first.
void add_grid(Mesh& mesh, int rows, int columns, bool round, const std::function<Vec3(double, double)>& place) {
  const int base = mesh.vertex_count();
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      mesh.positions.push_back(place(i / (rows - 1.0), round ? double(j) / columns : j / (columns - 1.0)));
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j + (round ? 0 : 1) < columns; ++j) {
      const int next = (j + 1) % columns;
      mesh.face_sizes.push_back(4);
      for (const int v : {i * columns + j, i * columns + next, (i + 1) * columns + next, (i + 1) * columns + j})
        mesh.face_vertices.push_back(base + v);
    }
}

double distance_to_line(const Vec3& p, std::span<const Vec3> line) {
  double out = std::numeric_limits<double>::infinity();
  for (const Vec3& q : resampled(line, 2001)) out = std::min(out, (p - q).norm());
  return out;
}

/// A quarter of a circle of radius 0.1 m from (0, 0.1, 0) on: 0 at its higher end.
Vec3 on_arc(double along) {
  return {0.1 * std::sin(along * pi / 2), 0.1 * std::cos(along * pi / 2), 0};
}

TEST(MiddleLines, Card_on_an_arc_has_the_arc) {
  Mesh mesh;
  add_grid(mesh, 17, 2, false,
           [](double a, double b) -> Vec3 { return on_arc(a) + Vec3(0, 0, (b - 0.5) * 0.02 * (1.2 - a)); });
  const MiddleLines out = middle_lines(mesh, {});
  ASSERT_EQ(out.strands.size(), 1u);
  const auto& line = out.strands[0];
  EXPECT_NEAR(length_of(line), 0.05 * pi, 0.002);  // 16 chords lose 0.1 %, ends a little
  // Ends are led on straight, over as much as a corner may cut off.
  EXPECT_LT((line.front() - on_arc(0)).norm(), 0.003);
  EXPECT_LT((line.back() - on_arc(1)).norm(), 0.003);
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    EXPECT_NEAR(std::hypot(line[i].x(), line[i].y()), 0.1, 0.0005);
    EXPECT_NEAR(line[i].z(), 0, 2e-4);
  }
  for (int i = 0; i < 17; ++i)
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(out.riders[at(2 * i + j)].along, i / 16.0, 0.02);
}

TEST(MiddleLines, Tube_has_its_axis) {
  Mesh mesh;
  add_grid(mesh, 21, 6, true, [](double a, double b) -> Vec3 {
    const double r = 0.01 * (1 - 0.7 * a);
    return Vec3(r * std::cos(2 * pi * b), -0.2 * a, r * std::sin(2 * pi * b));
  });
  const MiddleLines out = middle_lines(mesh, {});
  ASSERT_EQ(out.strands.size(), 1u);
  EXPECT_NEAR(length_of(out.strands[0]), 0.2, 0.001);
  EXPECT_NEAR(out.strands[0].front().y(), 0, 0.001);
  for (const Vec3& p : out.strands[0]) EXPECT_NEAR(std::hypot(p.x(), p.z()), 0, 5e-4);  // 5 % of the radius
}

TEST(MiddleLines, Scalp_says_where_the_root_is) {
  Mesh mesh;
  add_grid(mesh, 9, 2, false, [](double a, double b) -> Vec3 { return Vec3(0.01 * b, 0.2 * a, 0); });
  EXPECT_NEAR(middle_lines(mesh, {}).strands.at(0).front().y(), 0.2, 1e-3);
  const std::vector<Vec3> scalp{{0, -0.05, 0}, {0.01, -0.01, 0}};
  const MiddleLines out = middle_lines(mesh, scalp);
  EXPECT_NEAR(out.strands.at(0).front().y(), 0, 1e-3);
  EXPECT_NEAR(out.riders[0].along, 0, 1e-3);
  EXPECT_NEAR(out.riders.back().along, 1, 1e-3);
}

TEST(MiddleLines, Ribbon_over_a_head_is_two_strands_from_its_top) {
  Mesh mesh;
  add_grid(mesh, 41, 2, false, [](double a, double b) -> Vec3 {
    const double x = 2 * a - 1;
    return Vec3(0.2 * x, -0.4 * x * x, 0.01 * b);
  });
  const MiddleLines out = middle_lines(mesh, {});
  ASSERT_EQ(out.strands.size(), 2u);
  for (const auto& line : out.strands) {
    EXPECT_LT(line.front().norm(), 0.02);
    EXPECT_NEAR(line.back().y(), -0.4, 0.005);
  }
  EXPECT_LT(out.strands[0].back().x() * out.strands[1].back().x(), 0);
  EXPECT_EQ(out.riders.front().strand + out.riders.back().strand, 1);
}

TEST(MiddleLines, Caps_and_rings_get_no_strand_and_are_named) {
  Mesh mesh;
  add_grid(mesh, 9, 2, false, [](double a, double b) -> Vec3 { return Vec3(0.01 * b, -0.2 * a, 0); });
  const int cap = mesh.vertex_count();
  add_grid(mesh, 9, 9, false, [](double a, double b) -> Vec3 { return Vec3(0.02 + 0.1 * b, 0.05 * a, 0.001); });
  const int ring = mesh.vertex_count();
  add_grid(mesh, 3, 24, true, [](double a, double b) -> Vec3 {
    return Vec3(1 + 0.1 * std::cos(2 * pi * b), 0.01 * a, 0.1 * std::sin(2 * pi * b));
  });
  mesh.positions.emplace_back(0, 0, 0);  // in no face
  const MiddleLines out = middle_lines(mesh, {});
  EXPECT_EQ(out.strands.size(), 1u);
  ASSERT_EQ(out.notes.size(), 3u);
  EXPECT_NE(out.notes[0].find("128 triangles from vertex 19 on, 0.1 x 0.05 x 0 m"), std::string::npos) << out.notes[0];
  EXPECT_NE(out.notes[1].find("96 triangles from vertex 100 on, 0.2 x 0.01 x 0.2 m"), std::string::npos)
      << out.notes[1];
  EXPECT_NE(out.notes[2].find("1 of 3 pieces"), std::string::npos) << out.notes[2];
  // Of the cap, what is within reach rides on the card; the ring and the lone vertex do not.
  EXPECT_EQ(out.riders[at(cap)].strand, 0);
  EXPECT_FALSE(out.riders[at(cap)].of_strand);
  EXPECT_NEAR(out.riders[at(cap)].along, 0, 0.02);
  EXPECT_EQ(out.riders[at(ring - 1)].strand, -1);
  for (int v = ring; v < mesh.vertex_count(); ++v) EXPECT_EQ(out.riders[at(v)].strand, -1);
}

TEST(MiddleLines, Do_not_depend_on_where_the_mesh_stands) {
  Mesh mesh;
  add_grid(mesh, 17, 3, false, [](double a, double b) -> Vec3 { return on_arc(a) + Vec3(0, 0, (b - 0.5) * 0.02); });
  Mesh moved = mesh;
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
  for (Vec3& p : moved.positions) p = turn * p + Vec3(1, 2, 3);
  const auto a = middle_lines(mesh, {}).strands.at(0), b = middle_lines(moved, {}).strands.at(0);
  // Diagonals of the quads are as long as each other, so that rounding decides between them.
  EXPECT_NEAR(length_of(a), length_of(b), 0.001);
  for (const Vec3& p : a) EXPECT_LT(distance_to_line(turn * p + Vec3(1, 2, 3), b), 0.001);
}

TEST(LongWay, Degenerate_pieces_have_an_answer) {
  const std::vector<Triangle> one{{0, 1, 2}};
  EXPECT_TRUE(long_way(std::vector<Vec3>(3, Vec3(1, 2, 3)), one).empty());                 // a point
  EXPECT_TRUE(long_way(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, one).empty());  // a line
  EXPECT_TRUE(long_way(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}, {}).empty());
  for (const double thin : {1e-12, -1e-12}) {
    const auto ways = long_way(std::vector<Vec3>{{0, 0, 0}, {1, thin, 0}, {2, 0, 0}}, one);
    ASSERT_EQ(ways.size(), 3u);
    EXPECT_NEAR(std::abs(ways[2] - ways[0]), 1, 1e-6);
    EXPECT_NEAR(ways[1], 0.5, 0.01);
  }
}

TEST(Resampled, Vertices_are_at_even_distances_and_ends_are_kept) {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}, {1, 3, 0}};
  for (const int count : {2, 3, 9, 100}) {
    const auto out = resampled(line, count);
    ASSERT_EQ(out.size(), at(count));
    EXPECT_EQ(out.front(), line.front());
    EXPECT_EQ(out.back(), line.back());
    EXPECT_LE(length_of(out), length_of(line) + 1e-12);
    for (const Vec3& p : out) EXPECT_LT(distance_to_line(p, line), 4.0 / 2000);
  }
  const auto out = resampled(line, 9);  // 0.5 m apart, with the corner on a vertex
  for (std::size_t i = 1; i < out.size(); ++i) EXPECT_NEAR((out[i] - out[i - 1]).norm(), 0.5, 1e-12);
  EXPECT_NEAR(length_of(out), 4, 1e-12);
}

TEST(Resampled, Lines_without_length_and_repeated_vertices_have_an_answer) {
  EXPECT_EQ(resampled(std::vector<Vec3>{{1, 2, 3}}, 3), std::vector<Vec3>(3, Vec3(1, 2, 3)));
  EXPECT_EQ(resampled(std::vector<Vec3>(4, Vec3(1, 2, 3)), 3), std::vector<Vec3>(3, Vec3(1, 2, 3)));
  const std::vector<Vec3> line{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}};
  const auto out = resampled(line, 5);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_LT((out[i] - Vec3(0.5 * static_cast<double>(i), 0, 0)).norm(), 1e-12);
}

TEST(CutTo, Ends_at_the_length) {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {1, 3, 0}};
  EXPECT_EQ(cut_to(line, 2.5), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1.5, 0}}));
  EXPECT_EQ(cut_to(line, 1), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(cut_to(line, 7), line);
}

}  // namespace
}  // namespace ft

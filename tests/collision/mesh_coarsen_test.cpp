// Coarser meshes: fewer vertices, the same surface.
#include "collision/simplify/mesh_coarsen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace ft {
namespace {

struct Surface2 {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

/// Cells of 1 cm, alternating diagonals.
Surface2 sheet(int columns, int rows) {
  Surface2 s;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) s.points.emplace_back(0.01 * i, 0, 0.01 * j);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      if ((i + j) % 2 == 0)
        s.triangles.insert(s.triangles.end(), {{a, c, b}, {b, c, d}});
      else
        s.triangles.insert(s.triangles.end(), {{a, c, d}, {a, d, b}});
    }
  return s;
}

Surface2 tube(int around, int rows) {
  Surface2 s;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      s.points.emplace_back(0.15 * std::cos(angle), 0.01 * j, 0.15 * std::sin(angle));
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i, b = j * around + (i + 1) % around, c = a + around, d = b + around;
      s.triangles.insert(s.triangles.end(), {{a, c, b}, {b, c, d}});
    }
  return s;
}

std::vector<Vec3> kept_points(const Surface2& s, const CoarsenedMesh& m) {
  std::vector<Vec3> out;
  for (const int v : m.kept) out.push_back(s.points[at(v)]);
  return out;
}

double area(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += triangle_area(x[at(t[0])], x[at(t[1])], x[at(t[2])]);
  return sum;
}

/// Edges by the number of triangles at them.
std::map<std::size_t, int> edge_uses(std::span<const Triangle> triangles) {
  std::map<Edge, std::size_t> uses;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      ++uses[{a, b}];
    }
  std::map<std::size_t, int> out;
  for (const auto& [edge, count] : uses) ++out[count];
  return out;
}

int euler(const CoarsenedMesh& m) {
  return static_cast<int>(m.kept.size() - unique_edges(m.triangles).size() + m.triangles.size());
}

Vec3 placed(const Surface2& s, const CoarsenedMesh& m, std::size_t v) {
  Vec3 out = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) out += m.places[v].weight[k] * s.points[at(m.kept[at(m.places[v].vertex[k])])];
  return out;
}

TEST(Coarsen, A_sheet_keeps_a_quarter_of_its_vertices_its_outline_and_its_area) {
  const Surface2 s = sheet(40, 30);
  const CoarsenedMesh m = coarsen_mesh({s.points, s.triangles, {}, {}, 2});
  EXPECT_LT(m.kept.size(), 0.33 * static_cast<double>(s.points.size()));
  EXPECT_GT(m.kept.size(), 0.15 * static_cast<double>(s.points.size()));
  const std::vector<Vec3> x = kept_points(s, m);
  EXPECT_NEAR(area(x, m.triangles), 0.4 * 0.3, 1e-12);  // the corners are still there, and nothing overlaps
  for (const Triangle& t : m.triangles) {
    EXPECT_GT((x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).y(), 0);  // none is turned over
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((x[at(t[k])] - x[at(t[(k + 1) % 3])]).norm(), 0.037);
  }
  EXPECT_EQ(edge_uses(m.triangles).count(3), 0u);
  for (std::size_t v = 0; v < s.points.size(); ++v) EXPECT_LT((placed(s, m, v) - s.points[v]).norm(), 1e-12) << v;
}

TEST(Coarsen, A_tube_stays_a_tube) {
  const Surface2 s = tube(60, 30);
  const CoarsenedMesh m = coarsen_mesh({s.points, s.triangles, {}, {}, 2});
  EXPECT_LT(m.kept.size(), 0.35 * static_cast<double>(s.points.size()));
  EXPECT_EQ(euler(m), 0);
  EXPECT_EQ(edge_uses(m.triangles).count(3), 0u);
  const double sag = 0.15 * (1 - std::cos(0.5 * 0.045 / 0.15));  // of a chord as long as the longest edge
  for (std::size_t v = 0; v < s.points.size(); ++v) EXPECT_LT((placed(s, m, v) - s.points[v]).norm(), 2 * sag) << v;
}

TEST(Coarsen, A_tube_that_may_not_deviate_gets_coarser_along_its_axis_only) {
  const Surface2 s = tube(60, 30);
  CoarsenInput input{s.points, s.triangles, {}, {}, 2};
  input.deviation = 1e-4;  // a chord over two edges of the circle lies 0.8 mm inside
  const CoarsenedMesh m = coarsen_mesh(input);
  EXPECT_LT(m.kept.size(), 0.75 * static_cast<double>(s.points.size()));
  for (std::size_t v = 0; v < s.points.size(); ++v) EXPECT_LT((placed(s, m, v) - s.points[v]).norm(), 1e-4) << v;
}

TEST(Coarsen, No_edge_becomes_longer_than_wanted) {
  const Surface2 s = sheet(40, 30);
  CoarsenInput input{s.points, s.triangles, {}, {}, 4};
  input.longest = 0.02;
  const std::size_t limited = coarsen_mesh(input).kept.size();
  input.longest = std::numeric_limits<double>::infinity();
  const std::size_t free = coarsen_mesh(input).kept.size();
  EXPECT_GT(limited, 2 * free);
  EXPECT_LT(limited, s.points.size() / 2);
}

TEST(Coarsen, Vertices_of_a_group_stay_on_their_line_and_those_that_stay_stay) {
  const Surface2 s = sheet(30, 20);
  std::vector<int> group(s.points.size(), 0);
  for (int i = 0; i <= 30; ++i) group[at(10 * 31 + i)] = 1;  // a line across the sheet
  group[at(5 * 31 + 7)] = group[at(5 * 31 + 8)] = k_group_stays;
  const CoarsenedMesh m = coarsen_mesh({s.points, s.triangles, {}, group, 2});
  int on_line = 0, stay = 0;
  for (const int v : m.kept) on_line += group[at(v)] == 1, stay += group[at(v)] == k_group_stays;
  EXPECT_EQ(stay, 2);
  EXPECT_GE(on_line, 8);
  EXPECT_LT(on_line, 25);
  for (std::size_t v = 0; v < s.points.size(); ++v) EXPECT_LT((placed(s, m, v) - s.points[v]).norm(), 1e-12);
}

TEST(Coarsen, Pattern_coordinates_stay_those_of_their_points) {
  const Surface2 s = sheet(24, 24);
  // Two panels with coordinates of their own, joined at column 12.
  std::vector<std::array<Vec2, 3>> uvs;
  for (const Triangle& t : s.triangles) {
    double right = 0;
    for (const int v : t) right = std::max(right, s.points[at(v)].x());
    std::array<Vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k)
      uv[k] = Vec2(s.points[at(t[k])].x() + (right > 0.1201 ? 5 : 0), s.points[at(t[k])].z());
    uvs.push_back(uv);
  }
  const CoarsenedMesh m = coarsen_mesh({s.points, s.triangles, uvs, {}, 2});
  ASSERT_EQ(m.uvs.size(), m.triangles.size());
  EXPECT_LT(m.kept.size(), s.points.size() / 2);
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const double panel = m.uvs[t][0].x() > 3 ? 5 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = s.points[at(m.kept[at(m.triangles[t][k])])];
      EXPECT_NEAR(m.uvs[t][k].x(), p.x() + panel, 1e-12);
      EXPECT_NEAR(m.uvs[t][k].y(), p.z(), 1e-12);
    }
  }
}

TEST(Coarsen, No_triangle_of_a_pattern_turns_over) {
  const Surface2 s = sheet(24, 24);
  // The pattern is laid out on the body with a pleat: what is straight in the rest shape is a wave in the pattern.
  std::vector<std::array<Vec2, 3>> uvs(s.triangles.size());
  for (std::size_t t = 0; t < uvs.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = s.points[at(s.triangles[t][k])];
      uvs[t][k] = Vec2(p.x() + 0.04 * std::sin(p.z() * 80), p.z());
    }
  const auto least_area = [&](bool cut) {
    CoarsenInput input{s.points, s.triangles, uvs, {}, 3};
    input.cut = cut;
    const CoarsenedMesh m = coarsen_mesh(input);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& uv : m.uvs) {
      const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
      least = std::min(least, b.x() * a.y() - a.x() * b.y());  // the sheet is seen from below in (x, z)
    }
    return least;
  };
  EXPECT_LT(least_area(false), 0);
  EXPECT_GT(least_area(true), 0);
}

TEST(Coarsen, Nothing_is_drawn_to_where_the_pattern_is_slit) {
  // A fan of six triangles; in the pattern they are apart at the outer ends of the edges between them.
  std::vector<Vec3> x = {{0, 0, 0}};
  std::vector<Triangle> triangles;
  for (int k = 0; k < 6; ++k) {
    x.emplace_back(std::cos(k * std::numbers::pi / 3), std::sin(k * std::numbers::pi / 3), 0);
    triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
  }
  const auto kept = [&](double slit) {
    std::vector<std::array<Vec2, 3>> uvs;
    for (const Triangle& t : triangles) {
      uvs.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) uvs.back()[k] = x[at(t[k])].head<2>();
      uvs.back()[1] *= 1 + slit;
    }
    return coarsen_mesh({x, triangles, uvs, {}, 4}).kept.size();
  };
  EXPECT_LT(kept(0), x.size());
  EXPECT_EQ(kept(0.01), x.size());
}

TEST(Coarsen, What_cannot_be_collapsed_is_left_as_it_is) {
  // Three triangles at one edge, a degenerate one, and a vertex of none.
  const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {2, 0, 0}, {9, 9, 9}};
  const std::vector<Triangle> t = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}};
  const CoarsenedMesh m = coarsen_mesh({x, t, {}, {}, 4});
  EXPECT_EQ(m.kept.size(), x.size());
  EXPECT_EQ(m.triangles, t);
}

}  // namespace
}  // namespace ft

#include "collision/simplify/short_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "baker/core/mesh.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

/// A sheet of 6 x 6 squares of 10 mm. In every third of them, if `tiny` is above 0, lie four triangles with edges of
/// about that length in the middle of another [m].
struct Sheet {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
};

Sheet sheet(double tiny) {
  Sheet s;
  const int n = 7;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) s.x.emplace_back(0.01 * i, 0, 0.01 * j);
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const int a = j * n + i;
      s.triangles.push_back({a, a + n, a + n + 1});
      if (tiny > 0 && (i + j) % 3 == 0) {  // this one holds a triangle of triangles
        const Triangle t{a, a + n + 1, a + 1};
        const Vec3 middle = (s.x[at(t[0])] + s.x[at(t[1])] + s.x[at(t[2])]) / 3;
        const int first = static_cast<int>(s.x.size());
        for (int k = 0; k < 3; ++k) s.x.push_back(middle + 2 * tiny / 0.01 * (s.x[at(t[at(k)])] - middle));
        for (int k = 0; k < 3; ++k) s.x.push_back(0.5 * (s.x[at(first + k)] + s.x[at(first + (k + 1) % 3)]));
        const int p = first, q = first + 1, r = first + 2, pq = first + 3, qr = first + 4, rp = first + 5;
        s.triangles.insert(s.triangles.end(), {{p, pq, rp}, {pq, q, qr}, {rp, qr, r}, {pq, qr, rp}});
        const std::array<int, 3> inner{p, q, r}, between{pq, qr, rp};
        for (std::size_t k = 0; k < 3; ++k) {
          const int o0 = t[k], o1 = t[(k + 1) % 3];
          s.triangles.insert(s.triangles.end(),
                             {{o0, between[k], inner[k]}, {o0, o1, between[k]}, {o1, inner[(k + 1) % 3], between[k]}});
        }
      } else {
        s.triangles.push_back({a, a + n + 1, a + 1});
      }
    }
  return s;
}

ShortEdgesInput input_of(const Sheet& s, double shortest) {
  ShortEdgesInput in;
  in.rest = s.x;
  in.triangles = s.triangles;
  in.shortest = shortest;
  return in;
}

std::vector<Vec3> kept_points(const Sheet& s, const CoarsenedMesh& m) {
  std::vector<Vec3> out;
  for (const int v : m.kept) out.push_back(s.x[at(v)]);
  return out;
}

double area(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += triangle_area(x[at(t[0])], x[at(t[1])], x[at(t[2])]);
  return sum;
}

int euler(std::size_t vertices, std::span<const Triangle> triangles) {
  return static_cast<int>(vertices) - static_cast<int>(unique_edges(triangles).size()) +
         static_cast<int>(triangles.size());
}

TEST(ShortEdges, A_mesh_without_any_is_left_as_it_is) {
  const Sheet s = sheet(0);
  EXPECT_FALSE(has_short_edges(input_of(s, 1e-4)));
  const CoarsenedMesh m = collapse_short_edges(input_of(s, 1e-4));
  EXPECT_EQ(m.kept.size(), s.x.size());
  EXPECT_EQ(m.triangles, s.triangles);
}

TEST(ShortEdges, A_tiny_spot_becomes_a_vertex_and_its_vertices_lie_on_the_triangles_around_it) {
  const Sheet s = sheet(1e-5);
  ASSERT_TRUE(has_short_edges(input_of(s, 1e-4)));
  const CoarsenedMesh m = collapse_short_edges(input_of(s, 1e-4));
  EXPECT_EQ(m.kept.size(), 49u + 12u);
  const std::vector<Vec3> x = kept_points(s, m);
  EXPECT_NEAR(area(x, m.triangles), 0.0036, 1e-12);  // nothing overlaps, and nothing is lost
  EXPECT_EQ(euler(x.size(), m.triangles), 1);
  for (const Triangle& t : m.triangles) EXPECT_GT((x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).y(), 0);
  for (std::size_t v = 0; v < s.x.size(); ++v) {
    Vec3 placed = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) placed += m.places[v].weight[k] * x[at(m.places[v].vertex[k])];
    EXPECT_LT((placed - s.x[v]).norm(), 1e-15) << v;
    EXPECT_LT((x[at(m.into[v])] - s.x[v]).norm(), 1e-4) << v;
  }
}

TEST(ShortEdges, Corners_of_the_outline_that_a_knife_left_go_and_the_outline_stays) {
  Sheet s = sheet(0);
  // The first corner is cut off, 20 um from it.
  const int right = static_cast<int>(s.x.size()), up = right + 1;
  s.x.push_back(s.x[0] + Vec3(2e-5, 0, 0));
  s.x.push_back(s.x[0] + Vec3(0, 0, 2e-5));
  std::erase_if(s.triangles, [](const Triangle& t) { return t[0] == 0; });
  s.triangles.insert(s.triangles.end(), {{0, up, right}, {up, 7, 8}, {up, 8, right}, {right, 8, 1}});
  const CoarsenedMesh m = collapse_short_edges(input_of(s, 1e-4));
  EXPECT_EQ(m.kept.size(), 49u);
  EXPECT_NEAR(area(kept_points(s, m), m.triangles), 0.0036, 2e-7);
  EXPECT_EQ(euler(m.kept.size(), m.triangles), 1);
}

TEST(ShortEdges, Of_a_cut_edge_the_cut_goes_and_rides_on_the_edge) {
  Sheet s = sheet(0);
  const int n = 7, first = 3 * n + 3, last = first + n + 1, cut = static_cast<int>(s.x.size());
  s.x.push_back(s.x[at(first)] + 2e-5 * (s.x[at(last)] - s.x[at(first)]).normalized());
  std::erase_if(s.triangles, [&](const Triangle& t) {
    return std::count(t.begin(), t.end(), first) > 0 && std::count(t.begin(), t.end(), last) > 0;
  });
  s.triangles.insert(
      s.triangles.end(),
      {{first, first + n, cut}, {cut, first + n, last}, {first, cut, first + 1}, {cut, last, first + 1}});
  const CoarsenedMesh m = collapse_short_edges(input_of(s, 1e-4));
  EXPECT_EQ(m.kept.size(), 49u);
  EXPECT_EQ(m.into[at(cut)], first);
  for (std::size_t k = 0; k < 3; ++k) {
    const int v = m.places[at(cut)].vertex[k];
    if (v != first && v != last) {
      EXPECT_NEAR(m.places[at(cut)].weight[k], 0, 1e-12);
    }
  }
}

TEST(ShortEdges, A_button_of_tiny_triangles_stays_a_closed_surface) {
  Sheet s;
  make_sphere(3e-5, 12, 16, s.x, s.triangles);
  const CoarsenedMesh m = collapse_short_edges(input_of(s, 1e-4));
  EXPECT_GE(m.kept.size(), 4u);
  EXPECT_LT(m.kept.size(), s.x.size());
  EXPECT_EQ(euler(m.kept.size(), m.triangles), 2);
  std::map<Edge, int> uses;
  for (const Triangle& t : m.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[Edge{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
  for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2);
}

TEST(ShortEdges, The_last_triangle_of_a_piece_stays) {
  Sheet s;
  s.x = {{0, 0, 0}, {1e-5, 0, 0}, {0, 1e-5, 0}};
  s.triangles = {{0, 1, 2}};
  EXPECT_EQ(collapse_short_edges(input_of(s, 1e-4)).triangles, s.triangles);
}

TEST(ShortEdges, A_tube_that_is_thinner_than_the_shortest_edge_is_not_pinched_off) {
  Sheet s;
  const int around = 3, along = 8;
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * 3.14159265 * k / around;
      s.x.emplace_back(2e-5 * std::cos(angle), 0.01 * i, 2e-5 * std::sin(angle));
    }
  for (int i = 0; i + 1 < along; ++i)
    for (int k = 0; k < around; ++k) {
      const int a = i * around + k, b = i * around + (k + 1) % around;
      s.triangles.insert(s.triangles.end(), {{a, a + around, b}, {b, a + around, b + around}});
    }
  EXPECT_EQ(euler(s.x.size(), s.triangles), 0);
  const CoarsenedMesh m = collapse_short_edges(input_of(s, 1e-4));
  EXPECT_EQ(euler(m.kept.size(), m.triangles), 0);
}

TEST(ShortEdges, What_branches_and_what_is_degenerate_is_no_obstacle_to_the_rest) {
  Sheet s = sheet(1e-5);
  s.x.emplace_back(0.005, 0.01, 0);
  s.triangles.push_back({0, 1, static_cast<int>(s.x.size()) - 1});  // stands on an inner edge of the outline
  s.triangles.push_back({0, 7, 8});                                 // twice there
  const CoarsenedMesh m = collapse_short_edges(input_of(s, 1e-4));
  EXPECT_EQ(m.kept.size(), 50u + 12u);
}

TEST(ShortEdges, Held_vertices_are_drawn_to) {
  const Sheet s = sheet(1e-5);
  std::vector<char> held(s.x.size(), 0);
  for (std::size_t v = 49; v < s.x.size(); v += 6) held[v + 4] = 1;
  ShortEdgesInput in = input_of(s, 1e-4);
  in.held = held;
  const CoarsenedMesh m = collapse_short_edges(in);
  for (std::size_t v = 49; v < s.x.size(); v += 6) EXPECT_EQ(m.kept[at(m.into[v])], static_cast<int>(v + 4));
}

TEST(ShortEdges, An_edge_that_is_long_in_the_pattern_stays) {
  const Sheet s = sheet(1e-5);
  const auto kept = [&](double scale) {
    std::vector<std::array<Vec2, 3>> uvs;
    for (const Triangle& t : s.triangles) {
      uvs.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) uvs.back()[k] = Vec2(s.x[at(t[k])].z(), s.x[at(t[k])].x());
    }
    ShortEdgesInput in = input_of(s, 1e-4);
    in.uvs = uvs;
    in.pattern_scale = scale;
    return collapse_short_edges(in).kept.size();
  };
  EXPECT_EQ(kept(1), 49u + 12u);
  EXPECT_EQ(kept(100), s.x.size());
}

TEST(ShortEdges, Sides_of_a_seam_keep_coordinates_of_their_own) {
  // Two panels that meet in a line; the line's edges are cut 20 um from one end.
  Sheet s;
  std::vector<std::array<Vec2, 3>> uvs;
  const int n = 5;
  for (int j = 0; j < n; ++j)
    for (int i = -1; i <= 1; ++i) s.x.emplace_back(0.01 * i, 0, 0.01 * j);
  for (int j = 0; j + 1 < n; ++j) {
    const int cut = static_cast<int>(s.x.size());
    s.x.push_back(s.x[at(3 * j + 1)] + Vec3(0, 0, 2e-5));
    const int l = 3 * j, m = l + 1, r = l + 2;
    s.triangles.insert(
        s.triangles.end(),
        {{l, cut, m}, {l, l + 3, cut}, {l + 3, m + 3, cut}, {m, cut, r}, {cut, r + 3, r}, {cut, m + 3, r + 3}});
  }
  for (const Triangle& t : s.triangles) {
    double right = 0;
    for (const int v : t) right = std::max(right, s.x[at(v)].x());
    uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      uvs.back()[k] = Vec2(s.x[at(t[k])].z(), s.x[at(t[k])].x() + (right > 0 ? 5 : 0));
  }
  ShortEdgesInput in = input_of(s, 1e-4);
  in.uvs = uvs;
  in.pattern_scale = 1;
  const CoarsenedMesh m = collapse_short_edges(in);
  EXPECT_EQ(m.kept.size(), 15u);
  ASSERT_EQ(m.uvs.size(), m.triangles.size());
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const double panel = m.uvs[t][0].y() > 3 ? 5 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = s.x[at(m.kept[at(m.triangles[t][k])])];
      EXPECT_EQ(m.uvs[t][k], Vec2(p.z(), p.x() + panel));
    }
  }
}

}  // namespace
}  // namespace ft

// The certificate against slow and exact ones: orientation against rationals, edge-triangle against a vertex
// enumeration of the exact linear programme, the trees against all pairs. Lattice inputs make every degenerate case
// common.
#include "collision/check/crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <boost/rational.hpp>
#include <map>

#include "baker/core/random.h"
#include "capsule_scene.h"
#include "collision/check/crossing_predicates.h"

namespace ft {
namespace {

using Exact = boost::multiprecision::cpp_rational;
using Small = boost::rational<std::int64_t>;

struct Dice {
  std::uint64_t seed, draw = 0;
  double unit() { return random_uniform({seed, 1, 2, 3}, draw++); }
  int below(int n) { return static_cast<int>(unit() * n); }
  Vec3 lattice(int n) { return {double(below(n)), double(below(n)), double(below(n))}; }
  Vec3 point() { return {unit(), unit(), unit()}; }
};

int sign_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Exact m[3][3];
  const Vec3* rows[3] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) m[i][k] = Exact((*rows[i])[k]) - Exact(d[k]);
  const Exact det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                    m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                    m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det.sign();
}

/// Is there t, u, v with p + t (q - p) = a + u (b - a) + v (c - a), 0 <= t <= 1, u, v >= 0, u + v <= 1? A compact
/// polytope is empty or has a corner: every choice of active bounds that leaves one point is tried, in exact
/// arithmetic.
bool meets_exactly(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  using Row = std::array<Small, 4>;
  // boost::rational's comparisons with integers call themselves for ever in C++20: numerators are compared instead.
  const auto zero = [](const Small& x) { return x.numerator() == 0; };
  const auto whole = [](double x) { return Small(static_cast<std::int64_t>(x)); };
  std::vector<Row> equal;
  for (int k = 0; k < 3; ++k)
    equal.push_back({whole(q[k] - p[k]), whole(a[k] - b[k]), whole(a[k] - c[k]), whole(a[k] - p[k])});
  const std::array<Row, 5> bound{Row{1, 0, 0, 0}, Row{1, 0, 0, 1}, Row{0, 1, 0, 0}, Row{0, 0, 1, 0}, Row{0, 1, 1, 1}};
  for (unsigned active = 0; active < 32; ++active) {
    std::vector<Row> rows = equal;
    for (unsigned i = 0; i < 5; ++i)
      if (active >> i & 1) rows.push_back(bound[i]);
    std::size_t rank = 0;
    for (std::size_t column = 0; column < 3; ++column) {
      std::size_t pivot = rank;
      while (pivot < rows.size() && zero(rows[pivot][column])) ++pivot;
      if (pivot == rows.size()) continue;
      std::swap(rows[pivot], rows[rank]);
      for (std::size_t r = 0; r < rows.size(); ++r) {
        if (r == rank || zero(rows[r][column])) continue;
        const Small factor = rows[r][column] / rows[rank][column];
        for (std::size_t k = 0; k < 4; ++k) rows[r][k] -= factor * rows[rank][k];
      }
      ++rank;
    }
    if (rank < 3) continue;
    bool consistent = true;
    for (std::size_t r = 3; r < rows.size(); ++r) consistent = consistent && zero(rows[r][3]);
    if (!consistent) continue;
    const Small t = rows[0][3] / rows[0][0], u = rows[1][3] / rows[1][1], v = rows[2][3] / rows[2][2];
    const auto not_below = [](const Small& left, const Small& right) { return (left - right).numerator() >= 0; };
    if (not_below(t, 0) && not_below(1, t) && not_below(u, 0) && not_below(v, 0) && not_below(1, u + v)) return true;
  }
  return false;
}

TEST(Orientation, Agrees_with_rational_arithmetic_on_random_and_nearly_flat_points) {
  Dice dice{11};
  int zero = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::array<Vec3, 4> x;
    const int kind = trial % 4;
    for (Vec3& p : x) p = kind == 0 ? dice.point() : kind == 1 ? dice.lattice(4) : Vec3(0.1 * dice.lattice(9));
    if (kind >= 2) {
      // The fourth in the plane of the others but for rounding, and then some units in the last place beside it.
      const double u = dice.unit(), v = dice.unit();
      x[3] = x[0] + u * (x[1] - x[0]) + v * (x[2] - x[0]);
      if (kind == 3) x[3][dice.below(3)] *= 1 + (dice.below(5) - 2) * 0x1p-52;
    }
    const int expected = sign_exact(x[0], x[1], x[2], x[3]);
    ASSERT_EQ(orientation(x[0], x[1], x[2], x[3]), expected) << trial;
    ASSERT_EQ(orientation_exact(x[0], x[1], x[2], x[3]), expected) << trial;
    ASSERT_EQ(orientation(x[1], x[0], x[2], x[3]), -expected) << trial;
    zero += expected == 0;
  }
  EXPECT_GT(zero, 100);
}

TEST(Orientation, Is_exact_at_coordinates_of_very_different_size) {
  Dice dice{12};
  for (int trial = 0; trial < 1000; ++trial) {
    std::array<Vec3, 4> x;
    for (Vec3& p : x)
      for (int k = 0; k < 3; ++k) p[k] = std::ldexp(dice.unit() - 0.5, dice.below(120) - 60);
    ASSERT_EQ(orientation(x[0], x[1], x[2], x[3]), sign_exact(x[0], x[1], x[2], x[3])) << trial;
    const Vec2 a(x[0].x(), x[0].y()), b(x[1].x(), x[1].y()), c(x[2].x(), x[2].y());
    const Exact area = (Exact(a.x()) - Exact(c.x())) * (Exact(b.y()) - Exact(c.y())) -
                       (Exact(a.y()) - Exact(c.y())) * (Exact(b.x()) - Exact(c.x()));
    ASSERT_EQ(orientation_2d(a, b, c), area.sign()) << trial;
  }
}

TEST(Orientation, Is_positive_when_the_fourth_point_is_below) {
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-300}), -1);
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 0}), 0);
}

TEST(Crossings, Edge_and_triangle_agree_with_the_exact_programme_on_a_lattice) {
  Dice dice{13};
  int meeting = 0, flat = 0;
  for (int trial = 0; trial < 12000; ++trial) {
    const int n = 2 + trial % 4;
    const Vec3 p = dice.lattice(n), q = dice.lattice(n), a = dice.lattice(n), b = dice.lattice(n), c = dice.lattice(n);
    const bool expected = meets_exactly(p, q, a, b, c);
    // A shift and a power of two are exact: the answer must not move either.
    const Vec3 shift(3, -5, 7);
    ASSERT_EQ(edge_crosses_triangle(p, q, a, b, c), expected)
        << p.transpose() << " | " << q.transpose() << " | " << a.transpose() << " | " << b.transpose() << " | "
        << c.transpose();
    ASSERT_EQ(edge_crosses_triangle(q, p, b, c, a), expected);
    ASSERT_EQ(edge_crosses_triangle(q, p, c, b, a), expected);
    ASSERT_EQ(edge_crosses_triangle((p + shift) / 1024, (q + shift) / 1024, (a + shift) / 1024, (b + shift) / 1024,
                                    (c + shift) / 1024),
              expected);
    meeting += expected;
    flat += expected && orientation(a, b, c, p) == 0 && orientation(a, b, c, q) == 0;
  }
  EXPECT_GT(meeting, 1000);
  EXPECT_GT(flat, 300);
}

TEST(Crossings, Touching_counts_and_the_last_place_decides) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_TRUE(edge_crosses_triangle({0.2, 0.2, 0}, {0.2, 0.2, 1}, a, b, c));        // an end in the face
  EXPECT_FALSE(edge_crosses_triangle({0.2, 0.2, 5e-324}, {0.2, 0.2, 1}, a, b, c));  // the least distance there is
  EXPECT_TRUE(edge_crosses_triangle({0.5, 0, -1}, {0.5, 0, 1}, a, b, c));           // through an edge
  EXPECT_FALSE(edge_crosses_triangle({0.5, -5e-324, -1}, {0.5, -5e-324, 1}, a, b, c));
  EXPECT_TRUE(edge_crosses_triangle({0, 0, -1}, {0, 0, 1}, a, b, c));         // through a corner
  EXPECT_TRUE(edge_crosses_triangle({-1, 0.5, 0}, {2, 0.5, 0}, a, b, c));     // in the plane, across
  EXPECT_TRUE(edge_crosses_triangle({0.1, 0.1, 0}, {0.2, 0.2, 0}, a, b, c));  // in the plane, within
  EXPECT_FALSE(edge_crosses_triangle({1, 1, 0}, {2, 0.5, 0}, a, b, c));       // in the plane, beside
  EXPECT_TRUE(edge_crosses_triangle({0.1, 0.1, 0}, {0.1, 0.1, 0}, a, b, c));  // a point in the face
  EXPECT_TRUE(edge_crosses_triangle({0.5, -1, 0}, {0.5, 1, 0}, a, b, b));     // a triangle that is a segment
}

struct Soup {
  std::vector<Vec3> x;
  std::vector<Triangle> t;
};
/// Random triangles over shared vertices; on a lattice when n > 0.
Soup soup(Dice& dice, int vertices, int triangles, int n, double size = 0.3) {
  Soup s;
  for (int i = 0; i < vertices; ++i) s.x.push_back(n > 0 ? dice.lattice(n) : dice.point());
  while (static_cast<int>(s.t.size()) < triangles) {
    if (n > 0) {
      s.t.push_back({dice.below(vertices), dice.below(vertices), dice.below(vertices)});
      continue;
    }
    const int first = static_cast<int>(s.x.size());
    const Vec3 centre = dice.point();
    for (int k = 0; k < 3; ++k) s.x.push_back(centre + size * (dice.point() - Vec3::Constant(0.5)));
    s.t.push_back({first, first + 1, first + 2});
  }
  return s;
}

std::vector<Crossing> slowly_between(const Soup& a, const Soup& b) {
  std::vector<Crossing> out;
  for (const bool first : {true, false}) {
    const Soup &s = first ? a : b, &o = first ? b : a;
    for (const Edge& e : unique_edges(s.t))
      for (const Triangle& t : o.t)
        if (edge_crosses_triangle(s.x[at(e[0])], s.x[at(e[1])], o.x[at(t[0])], o.x[at(t[1])], o.x[at(t[2])]))
          out.push_back({e, t, first});
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<Crossing> slowly_within(const Soup& s) {
  std::vector<Crossing> out;
  for (const Edge& e : unique_edges(s.t))
    for (const Triangle& t : s.t)
      if (std::find(t.begin(), t.end(), e[0]) == t.end() && std::find(t.begin(), t.end(), e[1]) == t.end() &&
          edge_crosses_triangle(s.x[at(e[0])], s.x[at(e[1])], s.x[at(t[0])], s.x[at(t[1])], s.x[at(t[2])]))
        out.push_back({e, t, true});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

TEST(Crossings, Large_soups_are_searched_in_shares_that_make_up_the_whole) {
  Dice dice{15};
  const Soup a = soup(dice, 0, 600, 0, 0.15), b = soup(dice, 0, 500, 0, 0.15);
  const auto between = crossings_between(a.x, a.t, b.x, b.t);
  EXPECT_EQ(between, slowly_between(a, b));
  const auto within = crossings_within(a.x, a.t);
  EXPECT_EQ(within, slowly_within(a));
  EXPECT_GT(std::min(between.size(), within.size()), 50u);
}

TEST(Crossings, Trees_find_what_all_pairs_find) {
  Dice dice{14};
  std::size_t found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int n = trial % 3 == 0 ? 0 : 4 + trial % 5;
    const Soup a = soup(dice, n > 0 ? 30 : 0, 5 + dice.below(60), n),
               b = soup(dice, n > 0 ? 20 : 0, 5 + dice.below(60), n);
    const auto fast = crossings_between(a.x, a.t, b.x, b.t), slow = slowly_between(a, b);
    ASSERT_EQ(fast, slow) << trial;
    ASSERT_TRUE(std::is_sorted(fast.begin(), fast.end()));
    auto swapped = crossings_between(b.x, b.t, a.x, a.t);
    for (Crossing& c : swapped) c.edge_of_first = !c.edge_of_first;
    std::sort(swapped.begin(), swapped.end());
    ASSERT_EQ(swapped, fast) << trial;
    ASSERT_EQ(crossings_within(a.x, a.t), slowly_within(a)) << trial;
    found += fast.size();
  }
  EXPECT_GT(found, 1000u);
}

TEST(Crossings, Of_capsules_that_cross_form_closed_curves_and_disappear_when_they_part) {
  const test::Shape a = test::capsule({-0.3, 0.01, 0.003}, {0.3, 0.02, 0}, 0.1);
  const test::Shape b = test::capsule({0.01, -0.3, 0.002}, {0.013, 0.3, 0.05}, 0.06);
  const auto crossings = crossings_between(a.positions, a.triangles, b.positions, b.triangles);
  EXPECT_GT(crossings.size(), 50u);
  // In general position the closed curves enter and leave every triangle through its edges: an even number of times.
  std::map<std::pair<bool, Triangle>, int> ends;  // per surface and triangle
  for (const Crossing& c : crossings)
    for (const Triangle& t : c.edge_of_first ? a.triangles : b.triangles)
      if (std::find(t.begin(), t.end(), c.edge[0]) != t.end() && std::find(t.begin(), t.end(), c.edge[1]) != t.end())
        ++ends[{c.edge_of_first, t}];
  for (const auto& [triangle, count] : ends) EXPECT_EQ(count % 2, 0);
  std::vector<Vec3> away = b.positions;
  for (Vec3& p : away) p.z() += 0.3;
  EXPECT_TRUE(crossings_between(a.positions, a.triangles, away, b.triangles).empty());
  EXPECT_TRUE(crossings_within(a.positions, a.triangles).empty());
  EXPECT_TRUE(crossings_between(a.positions, {}, away, b.triangles).empty());
  EXPECT_TRUE(crossings_within({}, {}).empty());
}

TEST(Crossings, Flat_sheet_has_none_with_itself_and_a_copy_touches_everywhere) {
  Soup s;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) s.x.push_back({0.1 * i, 0.1 * j, 0});
  for (int i = 0; i < 19; ++i)
    for (int j = 0; j < 19; ++j) {
      const int v = 20 * i + j;
      s.t.insert(s.t.end(), {{v, v + 20, v + 21}, {v, v + 21, v + 1}});
    }
  EXPECT_TRUE(crossings_within(s.x, s.t).empty());
  EXPECT_EQ(crossings_between(s.x, s.t, s.x, s.t), slowly_between(s, s));
  std::vector<Vec3> above = s.x;
  for (Vec3& p : above) p.z() = 1e-300;
  EXPECT_TRUE(crossings_between(s.x, s.t, above, s.t).empty());
}

}  // namespace
}  // namespace ft

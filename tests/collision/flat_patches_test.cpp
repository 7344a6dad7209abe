// Flat patches against brute force: whatever shape the cloth has, no two features of a flat patch come nearer than half
// their distance at rest, at the states that were looked at and between them.
#include "collision/broad_phase/flat_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/geometry/pair_geometry.h"
#include "tests/collision/grid.h"
#include "tests/collision/pair_scene.h"

namespace ft {
namespace {

using test::Dice;

struct Sheet {
  std::vector<Vec3> rest;
  std::vector<Triangle> triangles;
};

/// n x n vertices one apart, moved about by `jitter`; one cell in `holes` is missing, 0: none.
Sheet make_sheet(int n, double jitter, Dice& dice, int holes = 0) {
  Sheet s;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) s.rest.emplace_back(i + jitter * dice.uniform(), 0, j + jitter * dice.uniform());
  std::vector<Triangle> all;
  test::add_grid_triangles(n, 0, all);
  for (std::size_t k = 0; k < all.size(); k += 2) {
    if (holes > 0 && dice.below(holes) == 0) continue;
    s.triangles.push_back(all[k]);
    s.triangles.push_back(all[k + 1]);
  }
  return s;
}

Vec3 middle_of(const Sheet& s, int triangle) {
  const Triangle& t = s.triangles[at(triangle)];
  return (s.rest[at(t[0])] + s.rest[at(t[1])] + s.rest[at(t[2])]) / 3;
}

double distance(PairKind kind, const std::array<int, 4>& v, std::span<const Vec3> x) {
  return pair_geometry(kind, {x[at(v[0])], x[at(v[1])], x[at(v[2])], x[at(v[3])]}).distance;
}

/// Calls look(kind, vertices) for all pairs of features of two triangles that have no vertex in common.
void for_pairs(const Triangle& a, const Triangle& b, auto&& look) {
  for (const auto& [p, f] : {std::pair{a, b}, std::pair{b, a}})
    for (const int v : p)
      if (std::find(f.begin(), f.end(), v) == f.end())
        look(PairKind::k_vertex_face, std::array<int, 4>{v, f[0], f[1], f[2]});
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::array<int, 4> v{a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]};
      if (v[0] != v[2] && v[0] != v[3] && v[1] != v[2] && v[1] != v[3]) look(PairKind::k_edge_edge, v);
    }
}

/// The smallest distance of a pair inside a flat patch, by that at rest.
double least_share(const FlatPatches& patches, const Sheet& s, std::span<const Vec3> x) {
  double least = 1e30;
  for (int p = 0; p < patches.members().row_count(); ++p) {
    if (patches.flat()[at(p)] == 0) continue;
    for (const int t : patches.members(p))
      for (const int u : patches.members(p))
        if (t < u)
          for_pairs(s.triangles[at(t)], s.triangles[at(u)], [&](PairKind kind, const std::array<int, 4>& v) {
            least = std::min(least, distance(kind, v, x) / distance(kind, v, s.rest));
          });
  }
  return least;
}

int flat_count(const FlatPatches& patches) {
  return static_cast<int>(std::count(patches.flat().begin(), patches.flat().end(), 1));
}

TEST(FlatPatches, Every_near_pair_of_a_sheet_is_inside_one) {
  Dice dice(1);
  const Sheet s = make_sheet(14, 0.2, dice);
  FlatPatches patches(s.rest, s.triangles, 1.2);
  patches.begin(s.rest);
  EXPECT_EQ(flat_count(patches), patches.members().row_count());
  std::vector<std::vector<int>> of(s.triangles.size());
  for (int p = 0; p < patches.members().row_count(); ++p)
    for (const int t : patches.members(p)) of[at(t)].push_back(p);
  int apart = 0, near = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (std::size_t u = 0; u < t; ++u) {
      bool is_near = false;
      for_pairs(s.triangles[t], s.triangles[u], [&](PairKind kind, const std::array<int, 4>& v) {
        is_near = is_near || distance(kind, v, s.rest) < 1.2;
      });
      if (!is_near) continue;
      ++near;
      std::vector<int> common;
      std::set_intersection(of[t].begin(), of[t].end(), of[u].begin(), of[u].end(), std::back_inserter(common));
      apart += common.empty();
    }
  // At the ragged hem of this sheet hulls are cut: there some are left to the search.
  EXPECT_LT(apart, near / 10) << near;
}

TEST(FlatPatches, Their_features_keep_half_of_their_distance_at_rest) {
  int flat = 0, not_flat = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Dice dice(seed);
    Sheet s = make_sheet(10, 0.3, dice, 30);
    const double curve = dice.uniform(0, 0.15);  // of the rest shape
    for (Vec3& p : s.rest) p.y() = curve * std::sin(0.7 * p.x());
    FlatPatches patches(s.rest, s.triangles, dice.uniform(0.1, 2));
    const Vec3 axis = dice.cube(1).normalized();
    const auto shape = [&](double amount) {
      const double bend = amount * dice.uniform(0, 0.8), wave = amount * dice.uniform(0, 1), noise = 0.1 * amount;
      std::vector<Vec3> x;
      for (const Vec3& p : s.rest) {
        Vec3 q = bend > 1e-9 ? Vec3(std::sin(bend * p.x()) / bend, (1 - std::cos(bend * p.x())) / bend, p.z()) : p;
        q.y() += wave * std::sin(p.z()) + p.y();
        x.push_back(Eigen::AngleAxisd(amount, axis) * (q + noise * dice.cube(1)));
      }
      return x;
    };
    const std::vector<Vec3> start = shape(dice.uniform(0, 1));
    patches.begin(start);
    EXPECT_GE(least_share(patches, s, start), 0.5) << seed;
    std::vector<Vec3> from = start;
    for (int move = 0; move < 3; ++move) {
      std::vector<Vec3> to = shape(dice.uniform(0, 1));
      const double share = dice.uniform(0, 0.5);
      for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + share * (to[i] - from[i]);
      std::vector<int> lost;
      const int before = flat_count(patches);
      const bool all = patches.keep(to, dice.below(2) == 0, lost);
      EXPECT_EQ(all, lost.empty());
      EXPECT_EQ(before - static_cast<int>(lost.size()), flat_count(patches));
      for (const double t : {0.3, 0.7, 1.0}) {
        std::vector<Vec3> between(from);
        for (std::size_t i = 0; i < to.size(); ++i) between[i] += t * (to[i] - from[i]);
        EXPECT_GE(least_share(patches, s, between), 0.5) << seed << " " << move << " " << t;
      }
      from = to;
      flat += flat_count(patches);
      not_flat += static_cast<int>(lost.size());
    }
  }
  EXPECT_GT(flat, 500);
  EXPECT_GT(not_flat, 300);
}

TEST(FlatPatches, Turned_and_shrunk_cloth_is_flat_as_far_as_the_closed_form_says) {
  Dice dice(7);
  const Sheet s = make_sheet(12, 0.2, dice);
  const auto flat_at = [&](const auto& map, bool to_spare) {
    FlatPatches patches(s.rest, s.triangles, 0.5);
    patches.begin(s.rest);
    std::vector<Vec3> x;
    for (const Vec3& p : s.rest) x.push_back(map * p);
    std::vector<int> lost;
    patches.keep(x, to_spare, lost);
    const int count = flat_count(patches);
    EXPECT_TRUE(count == 0 || lost.empty());
    return count > 0;
  };
  const double degree = std::numbers::pi / 180;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.6, 0, 0.8)}) {  // m = cos
    EXPECT_TRUE(flat_at(Eigen::AngleAxisd(59.8 * degree, axis), false));
    EXPECT_FALSE(flat_at(Eigen::AngleAxisd(60.1 * degree, axis), false));
    EXPECT_TRUE(flat_at(Eigen::AngleAxisd(50 * degree, axis), true));
    EXPECT_FALSE(flat_at(Eigen::AngleAxisd(56 * degree, axis), true));
  }
  EXPECT_TRUE(flat_at(Eigen::Scaling(0.503), false));  // m = the scale
  EXPECT_FALSE(flat_at(Eigen::Scaling(0.499), false));
}

TEST(FlatPatches, A_fold_is_in_none) {
  Dice dice(3);
  const Sheet s = make_sheet(12, 0, dice);
  FlatPatches patches(s.rest, s.triangles, 0.5);
  std::vector<Vec3> x = s.rest;
  for (Vec3& p : x)
    if (p.x() > 5) p.x() = 10 - p.x(), p.y() += 0.01;
  patches.begin(x);
  ASSERT_GT(flat_count(patches), 0);
  for (int p = 0; p < patches.members().row_count(); ++p) {
    if (patches.flat()[at(p)] == 0) continue;
    bool below = false, above = false;
    for (const int t : patches.members(p)) (middle_of(s, t).x() > 5 ? above : below) = true;
    EXPECT_FALSE(below && above) << p;
  }
}

/// Sheets that are joined along an edge and wound against each other face the same way where they lie on each other.
TEST(FlatPatches, A_fold_at_rest_whose_sides_are_wound_against_each_other_is_in_none) {
  for (const double turn : {0.1, 1.7, 3.3, 4.9}) {  // which way the fold runs on the plane must not matter
    Dice dice(3);
    Sheet s = make_sheet(12, 0, dice);
    std::vector<char> above(s.triangles.size(), 0);
    for (std::size_t t = 0; t < s.triangles.size(); ++t)
      if (middle_of(s, static_cast<int>(t)).x() > 5) above[t] = 1, std::swap(s.triangles[t][1], s.triangles[t][2]);
    for (Vec3& p : s.rest) {
      if (p.x() > 5) p.x() = 10 - p.x(), p.y() += 0.01 * (5 - p.x());
      p = Vec3(std::cos(turn) * p.x() - std::sin(turn) * p.z(), p.y(), std::sin(turn) * p.x() + std::cos(turn) * p.z());
    }
    FlatPatches patches(s.rest, s.triangles, 0.5);
    patches.begin(s.rest);
    ASSERT_GT(flat_count(patches), 0);
    for (int p = 0; p < patches.members().row_count(); ++p) {
      int of_above = 0, all = 0;
      for (const int t : patches.members(p)) of_above += above[at(t)], ++all;
      EXPECT_TRUE(of_above == 0 || of_above == all) << p << " turned by " << turn;
    }
  }
}

/// A cut that is as narrow as nothing: its lips can slide over each other while every triangle stays flat.
TEST(FlatPatches, None_has_both_lips_of_a_slit) {
  Dice dice(5);
  Sheet s = make_sheet(16, 0, dice);
  const int n = 16, row = 7;  // vertices of row 7 from column 4 on are there twice
  std::vector<int> twin(s.rest.size(), -1);
  for (int j = 4; j < n; ++j) {
    twin[at(row * n + j)] = static_cast<int>(s.rest.size());
    s.rest.push_back(s.rest[at(row * n + j)]);
  }
  for (Triangle& t : s.triangles) {
    const double middle = (s.rest[at(t[0])].x() + s.rest[at(t[1])].x() + s.rest[at(t[2])].x()) / 3;
    for (int& v : t)
      if (middle > row && twin[at(v)] >= 0) v = twin[at(v)];
  }
  const FlatPatches patches(s.rest, s.triangles, 1.0);
  int near = 0;
  for (int p = 0; p < patches.members().row_count(); ++p) {
    bool below = false, above = false;
    for (const int t : patches.members(p)) {
      const Vec3 middle = middle_of(s, t);
      if (middle.z() < 5) continue;
      (middle.x() > row ? above : below) = true;
      near += std::abs(middle.x() - row) < 1;
    }
    EXPECT_FALSE(below && above) << p;
  }
  EXPECT_GT(near, 50);
}

TEST(FlatPatches, The_way_between_two_members_lies_on_the_cloth) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Dice dice(seed);
    const Sheet s = make_sheet(14, 0.3, dice, 12);
    const FlatPatches patches(s.rest, s.triangles, 1.5);
    const auto on_cloth = [&](const Vec3& p) {
      return std::any_of(s.triangles.begin(), s.triangles.end(), [&](const Triangle& t) {
        const PairGeometry g = vertex_face_geometry(p, s.rest[at(t[0])], s.rest[at(t[1])], s.rest[at(t[2])]);
        return g.distance < 1e-3;
      });
    };
    const auto point_of = [&](int t) {
      const Triangle& v = s.triangles[at(t)];
      const double a = dice.uniform(), b = dice.uniform() * (1 - a);
      return Vec3(a * s.rest[at(v[0])] + b * s.rest[at(v[1])] + (1 - a - b) * s.rest[at(v[2])]);
    };
    for (int p = 0; p < patches.members().row_count(); ++p) {
      const auto members = patches.members(p);
      for (int k = 0; k < 20; ++k) {
        const Vec3 a = point_of(members[at(dice.below(static_cast<int>(members.size())))]);
        const Vec3 b = point_of(members[at(dice.below(static_cast<int>(members.size())))]);
        for (double t = 0; t <= 1; t += 0.1) ASSERT_TRUE(on_cloth(a + t * (b - a))) << seed << " " << p;
      }
    }
  }
}

TEST(FlatPatches, Soups_cords_and_slivers_do_no_harm) {
  int flat = 0, moved = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Dice dice(seed);
    Sheet s;
    const int n = 4 + dice.below(20);
    for (int i = 0; i < n; ++i) s.rest.push_back(dice.cube(1).cwiseProduct(Vec3(1, 0.1, 1)));
    for (int k = 0; k < 60; ++k) {
      Triangle t;
      for (int& v : t) v = dice.below(n);
      s.triangles.push_back(t);
    }
    FlatPatches patches(s.rest, s.triangles, 1);
    patches.begin(s.rest);
    std::vector<Vec3> x = s.rest;
    for (Vec3& p : x) p += dice.cube(0.1);
    std::vector<int> lost;
    flat += flat_count(patches);
    patches.keep(x, false, lost);
    EXPECT_GE(least_share(patches, s, x), 0.5) << seed;
    moved += flat_count(patches);
    std::vector<Vec3> broken = s.rest;
    broken[0].x() = std::numeric_limits<double>::quiet_NaN();
    patches.keep(broken, false, lost);
    for (int p = 0; p < patches.members().row_count(); ++p)
      for (const int t : patches.members(p))
        EXPECT_TRUE(patches.flat()[at(p)] == 0 ||
                    std::count(s.triangles[at(t)].begin(), s.triangles[at(t)].end(), 0) == 0);
  }
  EXPECT_GT(moved, 20);
  EXPECT_GT(flat, moved);
  const FlatPatches none({}, {}, 1);
  EXPECT_EQ(none.members().row_count(), 0);
}

}  // namespace
}  // namespace ft

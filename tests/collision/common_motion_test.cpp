// What neighbours have in common of a step may be made at once: nothing crosses, and patches keep their motion.
#include "collision/step_bound/common_motion.h"

#include <gtest/gtest.h>

#include <numbers>

#include "baker/core/parallel.h"
#include "collision/step_bound/truncate_dat.h"
#include "tests/collision/pair_scene.h"

namespace ft {
namespace {

using test::Dice;
using test::stays_apart;

constexpr double k_floor = 1e-5;

struct Cloth {
  std::vector<Vec3> x, dx;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;
  int movable_count = 0;
};

/// A square of cells x cells around the origin.
void add_square(Cloth& cloth, int cells, double size, double height) {
  const int first = static_cast<int>(cloth.x.size());
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      cloth.x.push_back(
          {size * (static_cast<double>(i) / cells - 0.5), height, size * (static_cast<double>(j) / cells - 0.5)});
  const auto vertex = [&](int i, int j) { return first + i + (cells + 1) * j; };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      cloth.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
      cloth.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
    }
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      if (i < cells) cloth.edges.push_back({vertex(i, j), vertex(i + 1, j)});
      if (j < cells) cloth.edges.push_back({vertex(i, j), vertex(i, j + 1)});
      if (i < cells && j < cells) cloth.edges.push_back({vertex(i, j), vertex(i + 1, j + 1)});
    }
}

/// All pairs without a vertex in common that the displacements could bring together.
ContactPairs all_pairs(const Cloth& cloth) {
  double most = 0;
  for (const Vec3& d : cloth.dx) most = std::max(most, d.norm());
  ContactPairs pairs;
  const auto add = [&](PairKind kind, const Stencil& s, std::vector<Stencil>& to) {
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = cloth.x[at(s.v[i])];
    if (pair_geometry(kind, x).distance < 2.3 * most + k_floor) to.push_back(s);
  };
  for (int v = 0; v < static_cast<int>(cloth.x.size()); ++v)
    for (const Triangle& t : cloth.triangles)
      if (v != t[0] && v != t[1] && v != t[2]) add(PairKind::k_vertex_face, {{v, t[0], t[1], t[2]}}, pairs.vertex_face);
  for (std::size_t a = 0; a < cloth.edges.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const auto &e = cloth.edges[a], &f = cloth.edges[b];
      if (e[0] != f[0] && e[0] != f[1] && e[1] != f[0] && e[1] != f[1])
        add(PairKind::k_edge_edge, {{e[0], e[1], f[0], f[1]}}, pairs.edge_edge);
    }
  return pairs;
}

struct Moved {
  std::vector<Vec3> common, displacement;
  int rounds = 0;
};

Moved move(const Cloth& cloth, const ContactPairs& pairs, bool together, const MotionBounds& bounds = {},
           const VertexClusters& clusters = {}) {
  const std::size_t n = at(cloth.movable_count);
  Moved out;
  out.common.assign(n, Vec3::Zero());
  CommonMotion finder;
  if (together) finder.find(cloth.x, cloth.dx, cloth.movable_count, pairs, k_floor, bounds, clusters, out.common);
  out.rounds = finder.rounds();
  std::vector<double> share(n);
  truncate_displacements(cloth.x, cloth.dx, out.common, cloth.movable_count, pairs, k_floor, share);
  for (std::size_t i = 0; i < n; ++i)
    out.displacement.push_back(out.common[i] + share[i] * (cloth.dx[i] - out.common[i]));
  return out;
}

/// Whether any pair does not stay apart when the movable vertices move by `displacement`.
int crossed(const Cloth& cloth, const ContactPairs& pairs, const std::vector<Vec3>& displacement) {
  int count = 0;
  const auto look = [&](PairKind kind, const std::vector<Stencil>& list) {
    for (const Stencil& s : list) {
      std::array<Vec3, 4> x, dx;
      for (std::size_t i = 0; i < 4; ++i) {
        x[i] = cloth.x[at(s.v[i])];
        dx[i] = s.v[i] < cloth.movable_count ? displacement[at(s.v[i])] : Vec3::Zero();
      }
      if (!stays_apart(kind, x, dx)) ++count;
    }
  };
  look(PairKind::k_vertex_face, pairs.vertex_face);
  look(PairKind::k_edge_edge, pairs.edge_edge);
  return count;
}

double way(const std::vector<Vec3>& displacement) {
  double sum = 0;
  for (const Vec3& d : displacement) sum += d.norm();
  return sum;
}

/// Two wavy sheets above each other and a still one below, pushed together and torn about.
Cloth hostile_sheets(std::uint64_t seed) {
  Cloth cloth;
  Dice dice(seed);
  const double size = 0.02, gap = std::pow(10, dice.uniform(-4.5, -3));
  for (const double height : {2 * gap, gap, 0.0}) add_square(cloth, 4, size, height);
  cloth.movable_count = 50;
  const Vec3 together = 5 * gap * dice.cube(1), wave = std::numbers::pi / size * dice.cube(1.5);
  const double rough = gap * std::pow(10, dice.uniform(-2, 1));
  for (Vec3& x : cloth.x) {
    x += 0.3 * gap * dice.cube(1);
    const double side = x.y() > 1.5 * gap ? -1 : 1;
    cloth.dx.push_back(together + Vec3(0, side * 2 * gap * (1 + std::sin(wave.dot(x))), 0) + rough * dice.cube(1));
  }
  return cloth;
}

TEST(CommonMotion, Nothing_crosses_whatever_the_displacements) {
  std::vector<int> crossings(400), unlike(400), joined(400);
  parallel_tasks(crossings.size(), [&](std::size_t i) {
    const Cloth cloth = hostile_sheets(50 + i);
    const ContactPairs pairs = all_pairs(cloth);
    const Moved moved = move(cloth, pairs, true);
    crossings[i] = crossed(cloth, pairs, moved.common) + crossed(cloth, pairs, moved.displacement);
    joined[i] = moved.rounds > 12 && way(moved.common) > 0;
    unlike[i] = way(moved.common) > 0 && way(moved.common) < 0.999 * way(cloth.dx);
    EXPECT_GT(crossed(cloth, pairs, cloth.dx) + (way(moved.common) > 0.999 * way(cloth.dx)), 0) << "nothing to do";
  });
  for (std::size_t i = 0; i < crossings.size(); ++i) EXPECT_EQ(crossings[i], 0) << i;
  EXPECT_GT(std::count(unlike.begin(), unlike.end(), 1), 100);
  EXPECT_GT(std::count(joined.begin(), joined.end(), 1), 50) << "pairs are left after the first rounds";
}

TEST(CommonMotion, A_patch_that_moves_by_many_edges_keeps_its_motion) {
  Cloth patch;
  add_square(patch, 8, 8e-3, 0);
  patch.movable_count = static_cast<int>(patch.x.size());
  for (const Vec3& x : patch.x)
    patch.dx.push_back(Vec3(4e-3, -6e-3, 5e-3) + 0.1 * Vec3(x.z(), x.x(), -x.x()));  // sheared and turned as well
  const ContactPairs pairs = all_pairs(patch);
  const Moved alone = move(patch, pairs, false), together = move(patch, pairs, true);
  EXPECT_EQ(together.displacement, patch.dx);
  EXPECT_LT(way(alone.displacement), 0.5 * way(patch.dx));
}

TEST(CommonMotion, What_meets_something_loses_the_approach_and_no_more) {
  Cloth cloth;
  add_square(cloth, 1, 2e-3, 1e-3);
  cloth.movable_count = 4;
  add_square(cloth, 1, 1, 0);
  cloth.dx.assign(cloth.x.size(), Vec3(3e-3, -4e-3, -2e-3));
  const Moved moved = move(cloth, all_pairs(cloth), true);
  for (const Vec3& d : moved.displacement) {
    EXPECT_NEAR(d.x(), 3e-3, 1e-12);
    EXPECT_NEAR(d.z(), -2e-3, 1e-12);
    EXPECT_NEAR(d.y(), -0.9 * (1e-3 - k_floor), 1e-6);
  }
}

TEST(CommonMotion, Bounds_hold) {
  for (const std::uint64_t seed : {3, 4, 5, 6, 7}) {
    Cloth cloth = hostile_sheets(seed);
    Dice dice(seed);
    std::vector<Vec3f> centre;
    std::vector<float> radius;
    for (std::size_t i = 0; i < at(cloth.movable_count); ++i) {  // x and x + dx on the ball, but for rounding
      centre.push_back((0.5 * cloth.dx[i] + 0.2 * cloth.dx[i].cross(dice.direction())).cast<float>());
      const Vec3 from = centre[i].cast<double>();
      radius.push_back(std::nextafter(static_cast<float>(std::max(from.norm(), (cloth.dx[i] - from).norm())), 1.0f));
    }
    const ContactPairs pairs = all_pairs(cloth);
    const Moved moved = move(cloth, pairs, true, {cloth.x, centre, radius});
    EXPECT_EQ(crossed(cloth, pairs, moved.displacement), 0);
    for (std::size_t i = 0; i < radius.size(); ++i)
      EXPECT_LE((moved.displacement[i] - centre[i].cast<double>()).norm(), radius[i] * (1 + 1e-9));
  }
}

TEST(CommonMotion, The_share_that_stays_in_a_ball_ends_on_it_and_is_a_number_for_what_rounding_left_outside) {
  const Vec3 from(0.6, 0, 0.8);  // outside of a ball of radius 1, by a bit
  const double radius = std::nextafter(from.norm(), 0);
  EXPECT_EQ(share_inside_ball(from, Vec3::Zero(), radius), 1);
  EXPECT_EQ(share_inside_ball(from, 0.1 * from, radius), 0);
  EXPECT_EQ(share_inside_ball(from, -0.1 * from, radius), 1);
  EXPECT_NEAR(share_inside_ball({0.5, 0, 0}, {2, 0, 0}, 1), 0.25, 1e-15);
  for (const double size : {1e-8, 1e-100, 1e-160, 1e-200, 1e-320})
    for (const Vec3& d : {Vec3(size, 0, 0), Vec3(-size, size, 0), Vec3(0, size, 0)}) {
      const double share = share_inside_ball(from, d, radius);
      EXPECT_TRUE(share >= 0 && share <= 1) << d.transpose();
    }
}

/// Clusters of vertices of a cloth that are joined by edges, however long; each of a few vertices.
VertexClusters some_clusters(const Cloth& cloth, std::uint64_t seed) {
  RestEdges edges;
  Dice dice(seed);
  for (const auto& e : cloth.edges)
    if (e[0] < cloth.movable_count && dice.uniform(0, 1) < 0.1) {
      edges.edges.push_back(e);
      edges.lengths.push_back(dice.uniform(1, 2));
    }
  return VertexClusters(edges, std::vector<double>(at(cloth.movable_count), 3.0));
}

TEST(CommonMotion, Nothing_crosses_where_vertices_lie_in_clusters_and_these_are_no_faster_than_before) {
  int clusters_moved = 0;
  for (std::uint64_t seed = 600; seed < 700; ++seed) {
    const Cloth cloth = hostile_sheets(seed);
    const ContactPairs pairs = all_pairs(cloth);
    const VertexClusters clusters = some_clusters(cloth, seed);
    EXPECT_GT(clusters.count(), 1);
    const Moved moved = move(cloth, pairs, true, {}, clusters);
    EXPECT_EQ(crossed(cloth, pairs, moved.common) + crossed(cloth, pairs, moved.displacement), 0) << seed;
    for (int v = 0; v < cloth.movable_count; ++v) {
      double longest = 0;
      for (const int i : clusters.with(v)) longest = std::max(longest, cloth.dx[at(i)].norm());
      EXPECT_LE(moved.common[at(v)].norm(), longest * (1 + 1e-9)) << seed;
      clusters_moved += clusters.of(v) >= 0 && moved.common[at(v)].norm() > 0.1 * longest;
    }
  }
  EXPECT_GT(clusters_moved, 100);
}

TEST(CommonMotion, Clusters_are_not_torn) {
  int torn_without = 0;
  for (std::uint64_t seed = 800; seed < 850; ++seed) {
    Cloth cloth = hostile_sheets(seed);
    const VertexClusters clusters = some_clusters(cloth, seed);
    clusters.take_mean(cloth.dx);
    const ContactPairs pairs = all_pairs(cloth);
    const Moved moved = move(cloth, pairs, true, {}, clusters), without = move(cloth, pairs, true);
    for (int v = 0; v < cloth.movable_count; ++v) {
      const auto first = at(clusters.with(v).front());
      EXPECT_LT((moved.common[at(v)] - moved.common[first]).norm(), 1e-12) << seed;
      torn_without += (without.common[at(v)] - without.common[first]).norm() > 1e-5;
    }
  }
  EXPECT_GT(torn_without, 100);
}

TEST(CommonMotion, Features_that_touch_do_not_move) {
  Cloth cloth;
  add_square(cloth, 1, 2e-3, 0);
  cloth.movable_count = 4;
  add_square(cloth, 1, 1e-3, 0);  // in the same plane
  cloth.dx.assign(cloth.x.size(), Vec3(0, -1e-3, 0));
  for (const Vec3& d : move(cloth, all_pairs(cloth), true).displacement) EXPECT_EQ(d, Vec3::Zero());
}

TEST(CommonMotion, The_early_way_out_of_truncation_changes_nothing) {
  int cut = 0;
  for (const std::uint64_t seed : {21, 22, 23, 24, 25}) {
    const Cloth cloth = hostile_sheets(seed);
    const ContactPairs pairs = all_pairs(cloth);
    const Moved moved = move(cloth, pairs, true);
    const std::size_t n = at(cloth.movable_count);
    std::vector<double> share(n, 1.0);
    for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge})
      for (const Stencil& s : kind == PairKind::k_vertex_face ? pairs.vertex_face : pairs.edge_edge) {
        const auto own = truncate_pair(kind, pair_move(s, cloth.x, cloth.dx, moved.common, n), k_floor);
        for (std::size_t i = 0; i < 4; ++i)
          if (at(s.v[i]) < n) share[at(s.v[i])] = std::min(share[at(s.v[i])], own[i]);
      }
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(moved.displacement[i], moved.common[i] + share[i] * (cloth.dx[i] - moved.common[i]))
          << seed << " " << i;
      cut += share[i] < 1;
    }
  }
  EXPECT_GT(cut, 20);
}

TEST(CommonMotion, Is_the_same_bits_for_any_thread_count) {
  Cloth cloth = hostile_sheets(11);
  const ContactPairs pairs = all_pairs(cloth);
  const Moved first = move(cloth, pairs, true);
  EXPECT_GT(first.rounds, 1);
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(move(cloth, pairs, true).displacement, first.displacement) << threads << " threads";
  }
}

}  // namespace
}  // namespace ft

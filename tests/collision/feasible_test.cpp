// The feasible collider against what it promises: no crossing between parts that are kept apart, half the gap at least
// between them, the larger part untouched, nothing moved where nothing overlaps, the same bits for any number of
// threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "capsule_scene.h"
#include "collision/body/feasible_collider.h"
#include "collision/check/crossings.h"
#include "collision/geometry/triangle_tree.h"

namespace ft {
namespace {

using test::CapsuleBody;
using Isometry = Eigen::Isometry3d;

constexpr double k_gap = 6e-3;

Isometry shift(const Vec3& by) {
  return Isometry(Eigen::Translation3d(by));
}

struct Judged {
  std::size_t crossings = 0;
  double distance = 1;  ///< m, between parts that are kept apart; 1 when farther than 5 cm
};

/// Exact crossings and smallest distance (vertices and edges' middles against triangles) of the parts that are kept
/// apart.
Judged judge(const FeasibleCollider& collider, std::span<const Vec3> x, int part_count) {
  std::vector<std::vector<Triangle>> parts(at(part_count));
  for (const Triangle& t : collider.triangles()) parts[at(collider.part_of_vertex()[at(t[0])])].push_back(t);
  Judged out;
  const auto nearest = [&](const std::vector<Triangle>& from, const std::vector<Triangle>& to) {
    const TriangleTree tree(x, to);
    for (const Triangle& t : from)
      for (std::size_t k = 0; k < 3; ++k)
        for (const Vec3& p : {x[at(t[k])], (0.5 * (x[at(t[k])] + x[at(t[(k + 1) % 3])])).eval()}) {
          if (tree.box().squared_distance(p) > 0.05 * 0.05) continue;
          TriangleTree::Hit hit;
          hit.closest.squared_distance = 0.05 * 0.05;
          tree.closest(p, x, to, hit);
          if (hit.triangle >= 0) out.distance = std::min(out.distance, std::sqrt(hit.closest.squared_distance));
        }
  };
  for (int a = 0; a < part_count; ++a)
    for (int b = a + 1; b < part_count; ++b) {
      if (!collider.kept_apart(a, b)) continue;
      out.crossings += crossings_between(x, parts[at(a)], x, parts[at(b)]).size();
      nearest(parts[at(a)], parts[at(b)]);
      nearest(parts[at(b)], parts[at(a)]);
    }
  return out;
}

std::vector<Vec3> carved(const FeasibleCollider& collider, std::span<const Vec3> drawn, CarveReport* report = nullptr) {
  std::vector<Vec3> x(at(collider.vertex_count()));
  const CarveReport r = collider.evaluate(drawn, x);
  if (report != nullptr) *report = r;
  return x;
}
std::vector<Vec3> refined(const FeasibleCollider& collider, std::span<const Vec3> drawn) {
  std::vector<Vec3> x(at(collider.vertex_count()));
  collider.refine(drawn, x);
  return x;
}

/// Hip (large) and forearm (small), far apart in the bind pose.
CapsuleBody hip_and_forearm() {
  return CapsuleBody(
      {{"hip", {-0.05, 1, 0}, {0.05, 1, 0}, 0.13, -1}, {"forearm", {0.6, 1.2, -0.1}, {0.6, 1.2, 0.13}, 0.04, -1}});
}

TEST(Feasible, Forearm_that_sinks_61_mm_into_the_hip_gives_way_without_a_crossing) {
  const CapsuleBody body = hip_and_forearm();
  const FeasibleCollider collider(body.surface, body.bind(), {});
  // The forearm's surface reaches 61 mm below the hip capsule's side at x = 0.
  const double x = 0.13 + 0.04 - 0.061;
  const auto drawn = body.pose({{shift({0, 0, 0}), shift(Vec3(x - 0.6 + 0.05, -0.2, 0))}});
  const auto before = refined(collider, drawn);
  EXPECT_GT(judge(collider, before, 2).crossings, 20u);
  CarveReport report;
  const auto after = carved(collider, drawn, &report);
  const Judged judged = judge(collider, after, 2);
  EXPECT_EQ(judged.crossings, 0u);
  EXPECT_GE(judged.distance, 0.5 * k_gap);
  EXPECT_EQ(report.part_a, 1);
  EXPECT_EQ(report.part_b, 0);
  EXPECT_NEAR(report.largest_move, 0.061 + k_gap, 4e-3);  // facets of 41 mm lie up to 1.6 mm inside their circle
  for (std::size_t v = 0; v < after.size(); ++v)
    if (collider.part_of_vertex()[v] == 0 || (before[v] - Vec3(0, 1, 0)).norm() > 0.05 + 0.13 + 0.05) {
      ASSERT_EQ(after[v], before[v]) << "the larger part moved, or a vertex far from it";
    }
}

TEST(Feasible, Random_poses_of_an_arm_on_hip_and_thighs_never_cross_slow) {
  const CapsuleBody body({{"hip", {-0.05, 1, 0}, {0.05, 1, 0}, 0.13, -1},
                          {"left thigh", {-0.1, 0.9, 0}, {-0.1, 0.45, 0}, 0.085, 0},
                          {"right thigh", {0.1, 0.9, 0}, {0.1, 0.46, 0}, 0.084, 0},
                          {"forearm", {0.8, 1.2, -0.1}, {0.8, 1.2, 0.13}, 0.04, -1},
                          {"hand", {0.8, 1.2, 0.2}, {0.8, 1.2, 0.25}, 0.035, 3}});
  const FeasibleCollider collider(body.surface, body.bind(), {});
  EXPECT_FALSE(collider.kept_apart(0, 1));
  EXPECT_TRUE(collider.kept_apart(0, 3));
  int crossing_before = 0;
  for (std::uint64_t trial = 0; trial < 24; ++trial) {
    const auto random = [&](std::uint64_t draw) { return 2 * random_uniform({7, 0, 0, trial}, draw) - 1; };
    Isometry arm = shift({random(0) * 0.12, 0.8 + 0.2 * random(1), 0.13 + 0.04 * random(2)});
    arm.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi + 0.4 * random(3),
                                 Vec3(0.3 * random(4), 1, 0.3 * random(5)).normalized()));
    arm.translate(Vec3(-0.8, -1.2, -0.1));
    const Isometry still = Isometry::Identity();
    const auto drawn = body.pose({{still, still, still, arm, arm}});
    crossing_before += judge(collider, refined(collider, drawn), 5).crossings > 0;
    const Judged judged = judge(collider, carved(collider, drawn), 5);
    EXPECT_EQ(judged.crossings, 0u) << "trial " << trial;
    EXPECT_GE(judged.distance, 0.5 * k_gap) << "trial " << trial;
  }
  EXPECT_GT(crossing_before, 12);
}

TEST(Feasible, Three_parts_that_overlap_each_other_are_all_kept_apart) {
  const CapsuleBody body({{"large", {-0.3, 0, 0}, {0.3, 0, 0}, 0.12, -1},
                          {"middle", {-0.2, 0.5, 0}, {0.2, 0.5, 0}, 0.09, -1},
                          {"small", {-0.1, 1, 0}, {0.1, 1, 0.02}, 0.05, -1}});
  const FeasibleCollider collider(body.surface, body.bind(), {});
  const auto drawn = body.pose({{shift({0, 0, 0}), shift({0, -0.34, 0}), shift({0, -0.9, 0.11})}});
  EXPECT_GT(judge(collider, refined(collider, drawn), 3).crossings, 50u);
  const Judged judged = judge(collider, carved(collider, drawn), 3);
  EXPECT_EQ(judged.crossings, 0u);
  // The middle part lies one gap from the large one; the small one ends at the lip of that slot, where there is less
  // room.
  EXPECT_GE(judged.distance, k_gap / 6);
}

TEST(Feasible, Jointed_parts_are_left_alone) {
  CapsuleBody body = hip_and_forearm();
  body.surface.parts[1].parent = 0;
  const FeasibleCollider collider(body.surface, body.bind(), {});
  const auto drawn = body.pose({{shift({0, 0, 0}), shift({-0.45, -0.2, 0})}});
  EXPECT_EQ(carved(collider, drawn), refined(collider, drawn));
}

TEST(Feasible, Bind_pose_is_not_moved_even_where_parts_overlap_in_it) {
  const CapsuleBody body({{"belly", {0, 1, 0}, {0, 1.2, 0}, 0.13, -1},
                          {"pelvis", {0, 0.9, 0}, {0, 0.95, 0}, 0.12, -1},
                          {"thigh", {0.08, 0.85, 0}, {0.1, 0.4, 0}, 0.08, -1}});
  const FeasibleCollider collider(body.surface, body.bind(), {});
  CarveReport report;
  EXPECT_EQ(carved(collider, body.bind(), &report), refined(collider, body.bind()));
  EXPECT_EQ(report.moved_vertices, 0);
  EXPECT_EQ(report.part_a, -1);
}

TEST(Feasible, Thighs_that_touch_above_are_still_kept_apart_below) {
  // Both reach into the crotch in the bind pose; crossing the legs makes the shins' ends overlap, not the tops.
  const CapsuleBody body(
      {{"left", {-0.05, 0.9, 0}, {-0.2, 0.4, 0}, 0.085, -1}, {"right", {0.05, 0.9, 0}, {0.2, 0.4, 0}, 0.084, -1}});
  const FeasibleCollider collider(body.surface, body.bind(), {});
  EXPECT_FALSE(collider.kept_apart(0, 1));
  Isometry swing = shift({0.05, 0.9, 0});
  swing.rotate(Eigen::AngleAxisd(-0.5, Vec3::UnitZ()));
  swing.translate(Vec3(-0.05, -0.9, 0));
  const auto drawn = body.pose({{Isometry::Identity(), swing}});
  const auto count_below = [&](const std::vector<Vec3>& x) {
    std::vector<Triangle> parts[2];
    for (const Triangle& t : collider.triangles())
      if (std::max({x[at(t[0])].y(), x[at(t[1])].y(), x[at(t[2])].y()}) < 0.6)
        parts[collider.part_of_vertex()[at(t[0])]].push_back(t);
    return crossings_between(x, parts[0], x, parts[1]).size();
  };
  EXPECT_GT(count_below(refined(collider, drawn)), 10u);
  EXPECT_EQ(count_below(carved(collider, drawn)), 0u);
}

TEST(Feasible, Carve_off_gives_the_refined_drawn_body) {
  const CapsuleBody body = hip_and_forearm();
  FeasibleSettings settings;
  settings.carve = false;
  const FeasibleCollider collider(body.surface, body.bind(), settings);
  const auto drawn = body.pose({{shift({0, 0, 0}), shift({-0.45, -0.2, 0})}});
  EXPECT_EQ(carved(collider, drawn), refined(collider, drawn));
}

TEST(Feasible, Result_has_the_same_bits_for_any_number_of_threads) {
  const CapsuleBody body = hip_and_forearm();
  const FeasibleCollider collider(body.surface, body.bind(), {});
  const auto drawn = body.pose({{shift({0, 0, 0}), shift({-0.45, -0.2, 0.01})}});
  const auto expected = carved(collider, drawn);
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    const auto x = carved(collider, drawn);
    EXPECT_EQ(std::memcmp(x.data(), expected.data(), x.size() * sizeof(Vec3)), 0) << threads;
  }
}

TEST(Feasible, Small_motions_of_the_body_give_small_motions_of_the_collider) {
  // The solver moves the collider linearly from pose to pose: a jump would sweep through the cloth. The forearm sinks
  // in by 0.5 mm steps; no vertex may move more than ten times that (the slope of a projection on a 41 mm facet's
  // neighbour).
  const CapsuleBody body = hip_and_forearm();
  const FeasibleCollider collider(body.surface, body.bind(), {});
  std::vector<Vec3> last;
  double largest = 0;
  for (int step = 0; step < 140; ++step) {
    const auto x = carved(collider, body.pose({{shift({0, 0, 0}), shift({-0.37 - 5e-4 * step, -0.2, 0.003})}}));
    for (std::size_t v = 0; v < last.size(); ++v) largest = std::max(largest, (x[v] - last[v]).norm());
    last = x;
  }
  EXPECT_LT(largest, 5e-3);
}

TEST(Feasible, Shell_that_is_inside_out_gives_the_same_result) {
  CapsuleBody body = hip_and_forearm();
  const auto drawn = body.pose({{shift({0, 0, 0}), shift({-0.45, -0.2, 0})}});
  const FeasibleCollider collider(body.surface, body.bind(), {});
  for (Triangle& t : body.surface.triangles) std::swap(t[1], t[2]);
  const FeasibleCollider flipped(body.surface, body.bind(), {});
  const auto x = carved(collider, drawn), y = carved(flipped, drawn);
  EXPECT_EQ(judge(flipped, y, 2).crossings, 0u);
  for (std::size_t v = 0; v < drawn.size(); ++v) EXPECT_LT((x[v] - y[v]).norm(), 5e-3) << v;
}

/// One closed skin: a tube whose middle bends until its last third lies on its first.
struct BentTube {
  test::Shape straight = test::capsule({0, 0, 0}, {1.2, 0, 0}, 0.06, 24, 8);
  Surface surface;
  BentTube() {
    // Rings along the side, so that it can bend.
    test::Shape s;
    const int rings = 61, segments = 24;
    for (int r = 0; r < rings; ++r)
      for (int k = 0; k < segments; ++k) {
        const double a = 2 * std::numbers::pi * k / segments, t = r / (rings - 1.0);
        const double radius = (0.08 - 0.03 * t) * (r == 0 || r == rings - 1 ? 0.6 : 1.0);
        s.positions.push_back({1.2 * t, radius * std::cos(a), radius * std::sin(a)});
      }
    for (int r = 0; r + 1 < rings; ++r)
      for (int k = 0; k < segments; ++k) {
        const int a = r * segments + k, b = r * segments + (k + 1) % segments;
        s.triangles.insert(s.triangles.end(), {{a, b, b + segments}, {a, b + segments, a + segments}});
      }
    const int first = static_cast<int>(s.positions.size()), last = first + 1;
    s.positions.push_back({0, 0, 0});
    s.positions.push_back({1.2, 0, 0});
    for (int k = 0; k < segments; ++k) {
      const int b = (k + 1) % segments, top = (rings - 1) * segments;
      s.triangles.push_back({first, b, k});
      s.triangles.push_back({last, top + k, top + b});
    }
    for (Triangle& t : s.triangles) std::swap(t[1], t[2]);  // outwards
    straight = s;
    surface.triangles = s.triangles;
    for (const Vec3& p : s.positions) surface.part_of_vertex.push_back(p.x() < 0.4 ? 0 : p.x() < 0.8 ? 1 : 2);
    surface.parts = {{"upper", -1, 3}, {"joint", 0, 2}, {"lower", 1, 1}};
  }
  /// The joint bends by angle; at pi the lower part lies beside the upper one, distance apart (axis to axis).
  std::vector<Vec3> bent(double distance) const {
    std::vector<Vec3> out;
    const double angle = std::numbers::pi, radius = 0.4 / angle, squeeze = distance / (2 * radius);
    for (const Vec3& p : straight.positions) {
      const double along = std::clamp(p.x() - 0.4, 0.0, 0.4), phi = along / radius;
      const double over = p.x() < 0.4 ? p.x() - 0.4 : p.x() > 0.8 ? p.x() - 0.8 : 0.0;
      const Vec3 centre(0.4 + radius * std::sin(phi), radius * (1 - std::cos(phi)) * squeeze, 0);
      const Vec3 tangent(std::cos(phi), std::sin(phi), 0), normal(-std::sin(phi), std::cos(phi), 0);
      out.push_back(centre + over * tangent + p.y() * normal + p.z() * Vec3::UnitZ());
    }
    return out;
  }
};

TEST(Feasible, Open_patches_of_one_skin_give_way_where_they_meet) {
  const BentTube tube;
  const FeasibleCollider collider(tube.surface, tube.straight.positions, {});
  EXPECT_TRUE(collider.kept_apart(0, 2));
  const auto drawn = tube.bent(0.1);  // radii 0.06 to 0.08 and 0.05 to 0.06: they overlap by about 30 mm
  EXPECT_GT(judge(collider, refined(collider, drawn), 3).crossings, 20u);
  CarveReport report;
  const auto x = carved(collider, drawn, &report);
  const Judged judged = judge(collider, x, 3);
  EXPECT_EQ(judged.crossings, 0u);
  EXPECT_GE(judged.distance, 0.5 * k_gap);
  EXPECT_EQ(report.part_a, 2);
  EXPECT_EQ(report.part_b, 0);
  EXPECT_LT(report.largest_move, 0.06);
  EXPECT_EQ(carved(collider, tube.straight.positions), refined(collider, tube.straight.positions));
}

TEST(Feasible, Copies_of_a_vertex_along_a_seam_move_together) {
  const CapsuleBody whole = hip_and_forearm();
  // Every triangle gets its own three vertices: the worst seam there is.
  Surface torn;
  torn.parts = whole.surface.parts;
  std::vector<int> source;
  for (const Triangle& t : whole.surface.triangles) {
    const int first = static_cast<int>(source.size());
    torn.triangles.push_back({first, first + 1, first + 2});
    for (const int v : t) source.push_back(v), torn.part_of_vertex.push_back(whole.surface.part_of_vertex[at(v)]);
  }
  const auto spread = [&](const std::vector<Vec3>& x) {
    std::vector<Vec3> out;
    for (const int v : source) out.push_back(x[at(v)]);
    return out;
  };
  const FeasibleCollider collider(torn, spread(whole.bind()), {});
  const auto drawn = spread(whole.pose({{shift({0, 0, 0}), shift({-0.45, -0.2, 0})}}));
  const auto before = refined(collider, drawn), after = carved(collider, drawn);
  std::map<std::array<double, 3>, Vec3> seen;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const auto [place, fresh] = seen.try_emplace({before[v].x(), before[v].y(), before[v].z()}, after[v]);
    if (!fresh) {
      ASSERT_LT((place->second - after[v]).norm(), 1e-12) << "crack at " << v;
    }
  }
  EXPECT_LT(seen.size(), before.size() / 2);
  EXPECT_EQ(judge(collider, after, 2).crossings, 0u);
}

TEST(Feasible, Body_of_one_part_and_empty_triangle_lists_are_only_refined) {
  Surface one;
  const test::Shape s = test::capsule({0, 0, 0}, {0, 0.3, 0}, 0.05);
  one.triangles = s.triangles;
  one.part_of_vertex.assign(s.positions.size(), 0);
  one.parts = {{"all", -1, 1}};
  const FeasibleCollider collider(one, s.positions, {});
  EXPECT_EQ(carved(collider, s.positions), refined(collider, s.positions));
  one.triangles.clear();
  one.parts.push_back({"nothing", -1, 0.5});
  const FeasibleCollider bare(one, s.positions, {});
  EXPECT_EQ(carved(bare, s.positions), s.positions);
}

}  // namespace
}  // namespace ft

// Creases of joints that bend far: room between the skins a body thickness away from the joint, nothing moved up to a
// right angle, no jumps while the joint closes; for capsules and for one skin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>

#include "baker/core/parallel.h"
#include "capsule_scene.h"
#include "collision/body/feasible_collider.h"
#include "collision/body/part_distance.h"
#include "collision/check/crossings.h"
#include "collision/geometry/triangle_tree.h"

namespace ft {
namespace {

using test::CapsuleBody;

constexpr double k_gap = 6e-3, k_radius = 0.045, k_degree = std::numbers::pi / 180;

/// An arm along x, its joint at the origin, that bends in the xy plane by an angle [rad].
struct Arm {
  Surface surface;
  std::vector<Vec3> bind;
  std::function<std::vector<Vec3>(double)> bent;
};

/// Two capsules that turn about the point where both end.
Arm capsule_arm() {
  const auto body = std::make_shared<CapsuleBody>(std::vector<CapsuleBody::Bone>{
      {"upper", {-0.3, 0, 0}, {0, 0, 0}, k_radius, -1}, {"lower", {0, 0, 0}, {0.28, 0, 0}, 0.9 * k_radius, 0}});
  return {body->surface, body->bind(), [body](double angle) {
            return body->pose(
                {{Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::AngleAxisd(angle, Vec3::UnitZ()))}});
          }};
}

/// One skin: rings around a middle line that bends on an arc of 10 cm, so that from 127 degrees on the inner side is
/// turned inside out there.
Arm skin_arm() {
  constexpr int k_rings = 65, k_segments = 24;
  constexpr double k_half_arc = 0.05;
  Arm arm;
  for (int r = 0; r < k_rings; ++r)
    for (int s = 0; s < k_segments; ++s) {
      const double around = 2 * std::numbers::pi * s / k_segments;
      arm.bind.push_back({-0.32 + 0.01 * r, k_radius * std::cos(around), k_radius * std::sin(around)});
    }
  for (int r = 0; r + 1 < k_rings; ++r)
    for (int s = 0; s < k_segments; ++s) {
      const int a = r * k_segments + s, b = r * k_segments + (s + 1) % k_segments;
      arm.surface.triangles.insert(arm.surface.triangles.end(),
                                   {{a, b + k_segments, b}, {a, a + k_segments, b + k_segments}});
    }
  for (const Vec3& p : arm.bind) arm.surface.part_of_vertex.push_back(p.x() < 0 ? 0 : 1);
  arm.surface.parts = {{"upper", -1, 1.0}, {"lower", 0, 0.8}};
  arm.bent = [bind = arm.bind](double angle) {
    std::vector<Vec3> out;
    const double curvature = std::max(angle, 1e-9) / (2 * k_half_arc);
    for (const Vec3& p : bind) {
      const double turned = curvature * std::clamp(p.x() + k_half_arc, 0.0, 2 * k_half_arc);
      const Vec3 forward(std::cos(turned), std::sin(turned), 0), up(-std::sin(turned), std::cos(turned), 0);
      const Vec3 middle = Vec3(std::min(p.x(), -k_half_arc), 0, 0) +
                          Vec3(std::sin(turned), 1 - std::cos(turned), 0) / curvature +
                          std::max(0.0, p.x() - k_half_arc) * forward;
      out.push_back(middle + p.y() * up + p.z() * Vec3::UnitZ());
    }
    return out;
  };
  return arm;
}

struct Posed {
  std::vector<Vec3> drawn, feasible;
};
Posed pose(const FeasibleCollider& collider, const Arm& arm, double angle) {
  Posed out;
  out.drawn.resize(at(collider.vertex_count()));
  out.feasible.resize(out.drawn.size());
  collider.refine(arm.bent(angle), out.drawn);
  collider.evaluate(arm.bent(angle), out.feasible);
  return out;
}

struct Judged {
  std::size_t crossings = 0;
  double distance = 1;  ///< m
};
/// Both parts against each other, as far as they are farther than `from` from the joint in the bind pose.
Judged judge(const FeasibleCollider& collider, const Arm& arm, std::span<const Vec3> x, double from) {
  std::vector<Vec3> bind(x.size());
  collider.refine(arm.bind, bind);
  std::vector<Triangle> parts[2];
  for (const Triangle& t : collider.triangles())
    if (std::all_of(t.begin(), t.end(), [&](int v) { return std::abs(bind[at(v)].x()) > from; }))
      parts[collider.part_of_vertex()[at(t[0])]].push_back(t);
  Judged out;
  out.crossings = crossings_between(x, parts[0], x, parts[1]).size();
  for (const int side : {0, 1}) {
    const TriangleTree tree(x, parts[1 - side]);
    for (const Triangle& t : parts[side])
      for (const int v : t) {
        TriangleTree::Hit hit;
        tree.closest(x[at(v)], x, parts[1 - side], hit);
        out.distance = std::min(out.distance, std::sqrt(hit.closest.squared_distance));
      }
  }
  return out;
}

/// farthest: how far one part reaches beyond the joint into the other in the bind pose [m].
void expect_room(const Arm& arm, double farthest, const char* name) {
  const FeasibleCollider collider(arm.surface, arm.bind, {});
  const Posed at_150 = pose(collider, arm, 150 * k_degree);
  const double from = farthest + k_radius + 2 * k_gap;
  EXPECT_GT(judge(collider, arm, at_150.drawn, from).crossings, 20u) << name;
  const Judged judged = judge(collider, arm, at_150.feasible, from);
  EXPECT_EQ(judged.crossings, 0u) << name;
  EXPECT_GE(judged.distance, 0.5 * k_gap) << name;
}

TEST(Creases, have_room_for_cloth_when_a_joint_bends_to_150_degrees) {
  expect_room(capsule_arm(), k_radius, "capsules");
  expect_room(skin_arm(), 0, "skin");
}

TEST(Creases, leave_the_body_as_drawn_up_to_a_right_angle) {
  for (const Arm& arm : {capsule_arm(), skin_arm()}) {
    const FeasibleCollider collider(arm.surface, arm.bind, {});
    for (const double angle : {0.0, 30.0, 60.0, 80.0}) {
      const Posed posed = pose(collider, arm, angle * k_degree);
      EXPECT_EQ(posed.feasible, posed.drawn) << angle;
    }
  }
}

TEST(Creases, begin_a_thickness_away_whatever_else_is_inside_the_part) {
  const CapsuleBody body({{"hip", {-0.07, 1, 0}, {0.07, 1, 0}, 0.13, -1},
                          {"belly", {0, 1.05, 0}, {0, 1.3, 0}, 0.12, 0},
                          {"left thigh", {-0.1, 0.97, 0}, {-0.12, 0.5, 0}, 0.085, 0},
                          {"right thigh", {0.1, 0.97, 0}, {0.12, 0.5, 0}, 0.085, 0}});
  const PartSurface surface(body.bind(), body.surface.triangles, body.surface.part_of_vertex, 4);
  // The caps of a capsule see farther than its sides.
  EXPECT_NEAR(surface.half_thickness(0), 0.13, 0.02);
  EXPECT_NEAR(surface.half_thickness(2), 0.085, 0.01);
}

TEST(Creases, move_smoothly_while_the_joint_closes) {
  // The solver moves the collider linearly from pose to pose: a jump would sweep through the cloth.
  for (const Arm& arm : {capsule_arm(), skin_arm()}) {
    const FeasibleCollider collider(arm.surface, arm.bind, {});
    Posed last = pose(collider, arm, 80 * k_degree);
    for (double angle = 80.25; angle <= 150; angle += 0.25) {
      const Posed now = pose(collider, arm, angle * k_degree);
      double drawn = 0, feasible = 0;
      for (std::size_t v = 0; v < now.drawn.size(); ++v) {
        drawn = std::max(drawn, (now.drawn[v] - last.drawn[v]).norm());
        feasible = std::max(feasible, (now.feasible[v] - last.feasible[v]).norm());
      }
      EXPECT_LT(feasible, 3 * drawn) << angle;
      last = now;
    }
  }
}

TEST(Creases, turn_with_the_body) {
  const Arm arm = skin_arm();
  const FeasibleCollider collider(arm.surface, arm.bind, {});
  const std::vector<Vec3> there = pose(collider, arm, 140 * k_degree).feasible;
  const Eigen::Isometry3d move = Eigen::Translation3d(1, -2, 3) * Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized());
  std::vector<Vec3> moved = arm.bent(140 * k_degree), x(there.size());
  for (Vec3& p : moved) p = move * p;
  collider.evaluate(moved, x);
  for (std::size_t v = 0; v < x.size(); ++v) EXPECT_LT((x[v] - move * there[v]).norm(), 1e-9) << v;
}

TEST(Creases, have_the_same_bits_for_any_number_of_threads) {
  const Arm arm = skin_arm();
  const FeasibleCollider collider(arm.surface, arm.bind, {});
  const std::vector<Vec3> expected = pose(collider, arm, 140 * k_degree).feasible;
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    const std::vector<Vec3> x = pose(collider, arm, 140 * k_degree).feasible;
    EXPECT_EQ(std::memcmp(x.data(), expected.data(), x.size() * sizeof(Vec3)), 0) << threads;
  }
}

}  // namespace
}  // namespace ft

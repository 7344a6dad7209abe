// Sheets in the feasible collider: a robe that is somebody's cache has no inside. Each expectation is also put to the
// same shapes without the mark, where it has to fail.
#include <gtest/gtest.h>

#include <algorithm>

#include "collision/body/feasible_collider.h"
#include "tests/collision/capsule_scene.h"

namespace ft {
namespace {

using test::CapsuleBody;

/// A wearer and a tube around it, open at both ends and larger than any of its limbs.
struct Dressed {
  Surface surface;
  std::vector<Vec3> bind;

  explicit Dressed(bool sheet) {
    const CapsuleBody body(
        {{"trunk", {0, 0.9, 0}, {0, 1.3, 0}, 0.12, -1}, {"hand", {0.5, 1, 0}, {0.5, 1.1, 0}, 0.04, -1}});
    surface = body.surface;
    bind = body.bind();
    constexpr int k_rings = 20, k_segments = 40;
    const int first = static_cast<int>(bind.size()), part = static_cast<int>(surface.parts.size());
    for (int r = 0; r <= k_rings; ++r)
      for (int s = 0; s < k_segments; ++s) {
        const double a = 2 * std::numbers::pi * s / k_segments;
        bind.emplace_back(0.2 * std::cos(a), 0.5 + r / 20.0, 0.2 * std::sin(a));
        surface.part_of_vertex.push_back(part);
      }
    const auto v = [&](int r, int s) { return first + r * k_segments + s % k_segments; };
    for (int r = 0; r < k_rings; ++r)
      for (int s = 0; s < k_segments; ++s) {
        surface.triangles.push_back({v(r, s), v(r + 1, s), v(r, s + 1)});
        surface.triangles.push_back({v(r + 1, s), v(r + 1, s + 1), v(r, s + 1)});
      }
    surface.parts.push_back({"robe", -1, sheet ? 0 : 0.1});
    surface.parts.back().sheet = sheet;
  }

  /// The hand goes through the robe, and the robe comes near the trunk.
  std::vector<Vec3> pose() const {
    std::vector<Vec3> x = bind;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (surface.part_of_vertex[i] == 1) x[i].x() -= 0.32;
      if (surface.part_of_vertex[i] == 2 && x[i].z() > 0.05) x[i].z() = std::min(x[i].z(), 0.123);
    }
    return x;
  }
};

struct Outcome {
  int moved = 0, absent = 0, kept_apart = 0;
};

Outcome outcome(bool sheet) {
  const Dressed dressed(sheet);
  const FeasibleCollider collider(dressed.surface, dressed.bind, {});
  std::vector<Vec3> x(at(collider.vertex_count()));
  std::vector<char> absent(x.size());
  Outcome out;
  out.moved = collider.evaluate(dressed.pose(), x, absent).moved_vertices;
  out.absent = static_cast<int>(std::count(absent.begin(), absent.end(), char{1}));
  out.kept_apart = collider.kept_apart(0, 2) || collider.kept_apart(1, 2);
  return out;
}

TEST(Sheet, Nothing_gives_way_to_a_sheet_or_is_absent_inside_it) {
  const Outcome sheet = outcome(true), solid = outcome(false);
  EXPECT_EQ(sheet.moved, 0);
  EXPECT_EQ(sheet.absent, 0);
  EXPECT_EQ(sheet.kept_apart, 0);
  EXPECT_GT(solid.moved, 100);
  EXPECT_GT(solid.absent, 10);
}

TEST(Sheet, It_is_met_as_it_is_drawn) {
  const Dressed dressed(true);
  const FeasibleCollider collider(dressed.surface, dressed.bind, {});
  const auto parts = collider.part_of_vertex();
  EXPECT_EQ(std::count(parts.begin(), parts.end(), 2),
            std::count(dressed.surface.part_of_vertex.begin(), dressed.surface.part_of_vertex.end(), 2))
      << "its long triangles are not refined: nothing there has to give way";
}

}  // namespace
}  // namespace ft

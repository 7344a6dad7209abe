// Plain surfaces are closed, face outwards and hold what their formulas say.
#include "baker/core/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace ft {
namespace {

double signed_volume(const TriangleSurface& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles)
    sum += s.positions[at(t[0])].dot(s.positions[at(t[1])].cross(s.positions[at(t[2])])) / 6;
  return sum;
}

void expect_closed(const TriangleSurface& s) {
  std::map<std::pair<int, int>, int> sides;
  for (const Triangle& t : s.triangles)
    for (int k = 0; k < 3; ++k) ++sides[{t[at(k)], t[at((k + 1) % 3)]}];
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(sides.contains({side.second, side.first})) << side.first << " " << side.second;
  }
}

TEST(Shapes, A_sphere_fills_up_as_it_is_refined) {
  const double full = 4.0 / 3 * std::numbers::pi * 0.008;
  double before = 4;
  for (const int levels : {0, 2, 4}) {
    const TriangleSurface s = sphere_surface(0.2, levels);
    EXPECT_EQ(s.triangles.size(), 8u << (2 * levels));
    expect_closed(s);
    const double lacks = 1 - signed_volume(s) / full;
    EXPECT_GT(lacks, 0);
    EXPECT_LT(lacks, before / 4);
    before = lacks;
  }
}

TEST(Shapes, A_box_has_the_volume_of_its_sides) {
  const TriangleSurface s = box_surface({0.2, 0.3, 0.5});
  expect_closed(s);
  EXPECT_NEAR(signed_volume(s), 0.03, 1e-15);
}

TEST(Shapes, A_capsule_is_two_half_spheres_and_a_cylinder) {
  const TriangleSurface s = capsule_surface(0.1, 0.4, 4);
  expect_closed(s);
  const double full = std::numbers::pi * 0.01 * 0.4 + 4.0 / 3 * std::numbers::pi * 0.001;
  EXPECT_NEAR(signed_volume(s) / full, 1, 0.01);
  EXPECT_NEAR(bounds(s.positions).size().y(), 0.6, 1e-12);
}

}  // namespace
}  // namespace ft

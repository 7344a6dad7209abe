#include "collision/check/sewn_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "baker/core/random.h"

namespace ft {
namespace {

/// Strip of cells: vertices 2 i and 2 i + 1 at x = i, numbered from `first`.
void add_strip(int cells, int first, std::vector<Triangle>& out) {
  for (int i = 0; i < cells; ++i) {
    const int a = first + 2 * i;
    out.push_back({a, a + 2, a + 3});
    out.push_back({a, a + 3, a + 1});
  }
}

bool near(const SewnPairs& sewn, int a, int b) {
  return sewn.together(std::array{a}, std::array{b});
}

TEST(SewnPairs, Without_stitches_nothing_is_together) {
  std::vector<Triangle> triangles;
  add_strip(3, 0, triangles);
  EXPECT_TRUE(SewnPairs().empty());
  EXPECT_FALSE(near(SewnPairs(), 0, 1));
  EXPECT_TRUE(SewnPairs(8, {}, triangles).empty());
}

TEST(SewnPairs, Both_sides_of_a_seam_are_together_and_one_step_along_it) {
  // Upper border of the first strip (1, 3, 5, 7) on the lower border of the second (8, 10, 12, 14).
  std::vector<Triangle> triangles;
  add_strip(3, 0, triangles);
  add_strip(3, 8, triangles);
  std::vector<Stitch> stitches;
  for (int i = 0; i < 4; ++i) stitches.push_back({1 + 2 * i, {8 + 2 * i, 8 + 2 * i}, 0, 0});
  const SewnPairs sewn(16, stitches, triangles);
  EXPECT_TRUE(near(sewn, 1, 8));
  EXPECT_TRUE(near(sewn, 8, 1));
  EXPECT_TRUE(near(sewn, 1, 10));
  EXPECT_TRUE(near(sewn, 10, 1));
  EXPECT_FALSE(near(sewn, 1, 12));  // two steps along
  EXPECT_FALSE(near(sewn, 1, 9));   // the far border
  EXPECT_FALSE(near(sewn, 1, 3));   // one panel's own
  EXPECT_FALSE(near(sewn, 1, 99));  // a body vertex, numbered after the cloth
  EXPECT_FALSE(near(sewn, 99, 1));
  EXPECT_TRUE(sewn.together(std::array{0, 3}, std::array{9, 10, 13}));
  EXPECT_TRUE(sewn.together(Crossing{{0, 1}, {8, 10, 11}, true}));
}

TEST(SewnPairs, Three_panels_in_a_corner_are_together) {
  std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const Stitch stitches[] = {{0, {3, 3}, 0, 0}, {6, {3, 3}, 0, 1}};
  const SewnPairs sewn(9, stitches, triangles);
  EXPECT_TRUE(near(sewn, 0, 6));
  EXPECT_TRUE(near(sewn, 6, 0));
  EXPECT_FALSE(near(sewn, 1, 7));
}

TEST(SewnPairs, The_relation_is_symmetric_for_any_stitches) {
  std::vector<Triangle> triangles;
  for (int k = 0; k < 5; ++k) add_strip(7, 16 * k, triangles);
  std::vector<Stitch> stitches;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto pick = [&](std::uint64_t n) { return static_cast<int>(80 * random_uniform({.element = i}, n)); };
    stitches.push_back({pick(0), {pick(1), pick(2)}, 0.3, 0});
  }
  const SewnPairs sewn(80, stitches, triangles);
  for (int a = 0; a < 80; ++a)
    for (int b = 0; b < 80; ++b) EXPECT_EQ(near(sewn, a, b), near(sewn, b, a)) << a << " " << b;
}

}  // namespace
}  // namespace ft

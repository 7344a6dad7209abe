// Two opinions that share no code: FCL's intersecting triangle pairs and our exact crossings.
#include <gtest/gtest.h>

#include <set>

#include "baker/core/random.h"
#include "capsule_scene.h"
#include "collision/check/crossings.h"
#include "collision/check/fcl_validator.h"

namespace ft {
namespace {

/// Triangle pairs that intersect, from the crossings: in general position every such pair has an edge of one through
/// the other.
std::size_t pairs_of_crossings(const test::Shape& a, const test::Shape& b) {
  std::set<std::pair<Triangle, Triangle>> pairs;
  for (const Crossing& c : crossings_between(a.positions, a.triangles, b.positions, b.triangles))
    for (const Triangle& t : c.edge_of_first ? a.triangles : b.triangles) {
      int shared = 0;
      for (const int v : t) shared += v == c.edge[0] || v == c.edge[1];
      if (shared == 2) pairs.insert(c.edge_of_first ? std::pair(t, c.triangle) : std::pair(c.triangle, t));
    }
  return pairs.size();
}

TEST(Validator, Counts_the_same_pairs_as_the_exact_crossings_for_capsules_in_random_poses) {
  std::size_t total = 0;
  int apart = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    const auto r = [&](std::uint64_t k) { return 2 * random_uniform({21, 0, 0, trial}, k) - 1; };
    const test::Shape a = test::capsule({-0.2, 0.01 * r(0), 0}, {0.2, 0.01 * r(1), 0.01 * r(2)}, 0.1);
    const test::Shape b =
        test::capsule({0.2 * r(3), 0.3 * r(4), 0.3 * r(5)}, {0.2 * r(6), 0.3 * r(7), 0.3 * r(8)}, 0.04);
    const std::size_t ours = pairs_of_crossings(a, b);
    EXPECT_EQ(fcl_intersecting_pairs(a.positions, a.triangles, b.positions, b.triangles), ours) << trial;
    total += ours;
    apart += ours == 0;
  }
  EXPECT_GT(total, 1000u);
  EXPECT_GT(apart, 2);
}

TEST(Validator, Finds_nothing_between_surfaces_that_are_a_hundredth_of_a_millimetre_apart) {
  const test::Shape a = test::capsule({0, 0, 0}, {0.3, 0, 0}, 0.1);
  test::Shape inner = test::capsule({0, 0, 0}, {0.3, 0, 0}, 0.1 - 1e-5);
  EXPECT_EQ(fcl_intersecting_pairs(a.positions, a.triangles, inner.positions, inner.triangles), 0u);
  EXPECT_TRUE(crossings_between(a.positions, a.triangles, inner.positions, inner.triangles).empty());
  for (Vec3& p : inner.positions) p.y() += 2e-5;
  EXPECT_GT(fcl_intersecting_pairs(a.positions, a.triangles, inner.positions, inner.triangles), 0u);
  EXPECT_FALSE(crossings_between(a.positions, a.triangles, inner.positions, inner.triangles).empty());
}

TEST(Validator, Empty_surfaces_have_no_pairs) {
  const test::Shape a = test::capsule({0, 0, 0}, {0.3, 0, 0}, 0.1);
  EXPECT_EQ(fcl_intersecting_pairs(a.positions, a.triangles, {}, {}), 0u);
  EXPECT_EQ(fcl_intersecting_pairs(a.positions, {}, a.positions, a.triangles), 0u);
}

}  // namespace
}  // namespace ft

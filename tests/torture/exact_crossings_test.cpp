// The independent checker against the certificate, where they must agree to the last crossing, and against cases worked
// by hand.
#include "tests/support/exact_crossings.h"

#include <gtest/gtest.h>

#include "baker/core/mesh.h"
#include "baker/core/random.h"
#include "collision/check/crossings.h"

namespace ft {
namespace {

struct Soup {
  std::vector<Vec3> x;
  std::vector<Triangle> t;
};

/// Triangles over shared vertices: anywhere, or (steps > 0) on a lattice, where everything is degenerate somewhere.
Soup soup(std::uint64_t seed, int vertices, int triangles, int steps) {
  Soup out;
  for (int i = 0; i < vertices; ++i) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const double u = random_uniform({seed, 1, 0, static_cast<std::uint64_t>(i)}, static_cast<std::uint64_t>(k));
      p[k] = steps > 0 ? 0.1 * std::floor(u * steps) : u;
    }
    out.x.push_back(p);
  }
  for (int i = 0; i < triangles; ++i) {
    Triangle t;
    for (int k = 0; k < 3; ++k)
      t[at(k)] = static_cast<int>(
          vertices * random_uniform({seed, 2, 0, static_cast<std::uint64_t>(i)}, static_cast<std::uint64_t>(k)));
    out.t.push_back(t);
  }
  return out;
}

std::vector<EdgeTriangle> certified(const std::vector<Crossing>& crossings, bool edge_of_first) {
  std::vector<EdgeTriangle> out;
  for (const Crossing& c : crossings)
    if (c.edge_of_first == edge_of_first) out.push_back({c.edge, c.triangle});
  return out;
}

TEST(ExactCrossings, are_those_of_the_certificate_one_by_one) {
  std::size_t found = 0;
  for (std::uint64_t trial = 0; trial < 24; ++trial) {
    const int steps = trial % 3 == 0 ? 0 : 2 + static_cast<int>(trial % 5);
    const Soup a = soup(2 * trial, 24, 30, steps), b = soup(2 * trial + 1, 20, 24, steps);
    const auto certificate = crossings_between(a.x, a.t, b.x, b.t);
    ASSERT_EQ(exact_crossings(a.x, a.t, b.x, b.t), certified(certificate, true)) << trial;
    ASSERT_EQ(exact_crossings(b.x, b.t, a.x, a.t), certified(certificate, false)) << trial;
    ASSERT_EQ(exact_own_crossings(a.x, a.t), certified(crossings_within(a.x, a.t), true)) << trial;
    found += certificate.size();
  }
  EXPECT_GT(found, 1500u);
}

TEST(ExactCrossings, tell_a_touch_from_the_least_distance_there_is) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_TRUE(exactly_meets({0.2, 0.2, 0}, {0.2, 0.2, 1}, a, b, c));
  EXPECT_FALSE(exactly_meets({0.2, 0.2, 5e-324}, {0.2, 0.2, 1}, a, b, c));
  EXPECT_TRUE(exactly_meets({0.5, 0, -1}, {0.5, 0, 1}, a, b, c));
  EXPECT_FALSE(exactly_meets({0.5, -5e-324, -1}, {0.5, -5e-324, 1}, a, b, c));
  EXPECT_TRUE(exactly_meets({-1, 0.5, 0}, {2, 0.5, 0}, a, b, c));
  EXPECT_TRUE(exactly_meets({0.1, 0.1, 0}, {0.2, 0.2, 0}, a, b, c));
  EXPECT_FALSE(exactly_meets({1, 1, 0}, {2, 0.5, 0}, a, b, c));
  EXPECT_TRUE(exactly_meets({0.5, -1, 0}, {0.5, 1, 0}, a, b, b));  // a triangle that is a segment
  EXPECT_TRUE(exactly_meets(a, a, a, a, a));                       // and one that is a point
  EXPECT_FALSE(exactly_meets(a, a, b, b, b));
}

TEST(ExactCrossings, look_at_triangles_that_are_far_larger_than_the_grid) {
  Soup a, b;
  for (int i = 0; i < 400; ++i) {  // dust, and one triangle across all of it
    const Vec3 p(1e-3 * (i % 20), 1e-3 * (i / 20), 0);
    a.x.insert(a.x.end(), {p, p + Vec3(1e-4, 0, 0), p + Vec3(0, 0, 1e-4)});
    a.t.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  b.x = {{-1e3, -1e3, 5e-5}, {1e3, -1e3, 5e-5}, {0, 1e3, 5e-5}};
  b.t = {{0, 1, 2}};
  EXPECT_EQ(exact_crossings(a.x, a.t, b.x, b.t).size(), 800u);
  a.x.insert(a.x.end(), b.x.begin(), b.x.end());
  a.t.push_back({1200, 1201, 1202});
  EXPECT_EQ(exact_own_crossings(a.x, a.t).size(), 800u);
}

}  // namespace
}  // namespace ft

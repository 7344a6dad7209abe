// Triangles that are next to no cloth: how elasticity goes round them.
#include "solvers/energies/caps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "solvers/energies/membrane.h"

namespace ft {
namespace {

/// A unit square of edge `size`, its diagonal a cap's base: 4 is `height` above its middle.
struct Sheet {
  std::vector<Vec3> rest;
  std::vector<Triangle> triangles{{0, 2, 4}, {2, 3, 4}, {3, 0, 4}, {2, 0, 1}};
  std::vector<std::array<Vec2, 3>> uvs;

  explicit Sheet(double height, double size = 0.02) {
    rest = {{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}};
    rest.emplace_back(0.5 * size - height / std::sqrt(2.0), 0.5 * size + height / std::sqrt(2.0), 0);
    for (const Triangle& t : triangles) {
      uvs.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) uvs.back()[k] = rest[at(t[k])].head<2>();
    }
  }
  ClothTopology topology(double pattern_scale = 0, bool with_uvs = true) const {
    ClothPiece piece{0, static_cast<int>(rest.size()), *find_fabric("cotton")};
    piece.pattern_scale = pattern_scale;
    return make_cloth_topology(rest, triangles, {&piece, 1}, with_uvs ? std::span(uvs) : decltype(std::span(uvs)){});
  }
};

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Caps, Are_parted_by_the_other_diagonal) {
  for (const double scale : {0.0, 1.0}) {
    const ClothTopology t = Sheet(1e-5).topology(scale);
    ASSERT_EQ(t.flipped_caps.size(), 1u);
    EXPECT_EQ(t.flipped_caps[0].vertex, 4);
    EXPECT_EQ(t.flipped_caps[0].base, (Edge{0, 2}));
    EXPECT_NEAR(t.flipped_caps[0].base_length, 0.02 * std::sqrt(2.0), 1e-12);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(t.rest_area[k], 1e-4, 1e-6) << k;
      EXPECT_EQ(cap_stiffness(t.rest_area[k], t.rest_inverse[k]), 1) << k;
      EXPECT_TRUE(std::ranges::count(t.triangles[k], 4)) << k;
    }
    EXPECT_EQ(t.hinges.size(), 4u);
    EXPECT_EQ(t.bends.size(), 4u);
    EXPECT_NEAR(sum(t.rest_area), 4e-4, 1e-15);
    EXPECT_NEAR(sum(t.mass), find_fabric("cotton")->mass_per_area * 4e-4, 1e-15);
  }
}

TEST(Caps, Have_the_stiffness_of_the_cloth_that_they_are_part_of) {
  const auto pull = [](double height) {
    const Sheet sheet(height);
    const ClothTopology t = sheet.topology();
    std::vector<Vec3> x = sheet.rest, gradient(x.size(), Vec3::Zero());
    for (Vec3& p : x) p.y() *= 1.01;
    Membrane(t).add_gradient(x, gradient);
    return gradient[2].y() + gradient[3].y();
  };
  EXPECT_NEAR(pull(1e-6) / pull(0.005), 1, 1e-6);  // 0.005: no cap
}

TEST(Caps, That_are_none_stay) {
  EXPECT_TRUE(Sheet(0.001).topology().flipped_caps.empty());
  EXPECT_EQ(Sheet(0.001).topology().triangles, Sheet(0.001).triangles);
}

TEST(Caps, Stay_where_nothing_lies_beyond_or_not_the_same_cloth) {
  const auto flips = [](const Sheet& sheet, bool with_uvs = true) {
    return sheet.topology(0, with_uvs).flipped_caps.size();
  };
  Sheet alone(1e-5);
  alone.triangles.pop_back(), alone.uvs.pop_back();
  EXPECT_EQ(flips(alone), 0u);
  Sheet seam(1e-5);  // of the pattern
  for (Vec2& uv : seam.uvs.back()) uv.x() += 1;
  EXPECT_EQ(flips(seam), 0u);
  EXPECT_EQ(flips(seam, false), 1u);
  Sheet turned(1e-5);  // inside out
  std::swap(turned.triangles.back()[0], turned.triangles.back()[1]);
  std::swap(turned.uvs.back()[0], turned.uvs.back()[1]);
  EXPECT_EQ(flips(turned), 0u);
  Sheet slanted(1e-5);  // no convex quadrilateral
  slanted.rest[1] = {-0.02, -0.0201, 0};
  EXPECT_EQ(flips(slanted, false), 0u);
  Sheet folded(4e-4);  // over the cap, along its base
  folded.rest[1] = {0.0021, 0.0079, 0};
  EXPECT_EQ(flips(folded, false), 0u);
  Sheet pocket(1e-5);  // three at an edge
  pocket.rest.emplace_back(0.01, 0.01, 0.02);
  pocket.triangles.push_back({0, 2, 5});
  EXPECT_EQ(flips(pocket, false), 0u);
  Sheet taken(1e-5);  // by another triangle, the other diagonal
  taken.rest.emplace_back(0.01, 0, 0.02);
  taken.triangles.push_back({4, 1, 5});
  EXPECT_EQ(flips(taken, false), 0u);
}

TEST(Caps, On_either_side_of_an_edge_stay) {
  Sheet sheet(1e-5);  // 1 is beyond a second cap's vertex 5
  sheet.triangles = {{0, 2, 4}, {2, 3, 4}, {3, 0, 4}, {2, 0, 5}, {0, 1, 5}, {1, 2, 5}};
  sheet.rest.emplace_back(0.01 + 1e-5, 0.01 - 1e-5, 0);
  const ClothTopology t = sheet.topology(0, false);
  EXPECT_TRUE(t.flipped_caps.empty());  // the other diagonal is next to nothing
  EXPECT_EQ(t.triangles, sheet.triangles);
}

}  // namespace
}  // namespace ft

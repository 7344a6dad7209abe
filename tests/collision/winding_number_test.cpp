// Winding numbers: whole in closed surfaces, the tree against all solid angles on open ones.
#include "collision/geometry/winding_number.h"

#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/random.h"
#include "open_body.h"

namespace ft {
namespace {

std::vector<Vec3> points_about(const test::Shape& s, int count) {
  Box box = bounds(s.positions);
  box.inflate(0.1);
  std::vector<Vec3> out;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    const auto r = [&](std::uint64_t k) { return random_uniform({11, 0, 0, i}, k); };
    out.push_back(box.lo + Vec3(r(0), r(1), r(2)).cwiseProduct(box.size()));
  }
  return out;
}

/// What the tree looks at, kept alive.
struct Field {
  explicit Field(const test::Shape& s) : tree(s.positions, s.triangles), winding(tree, s.positions, s.triangles) {}
  TriangleTree tree;
  WindingTree winding;
};

TEST(WindingNumber, Counts_the_closed_surfaces_about_a_point) {
  test::Shape s = test::capsule({0, 0, 0}, {0, 0.5, 0}, 0.2);
  const auto at_middle = [&] { return winding_number({0, 0.25, 0}, s.positions, s.triangles); };
  EXPECT_NEAR(at_middle(), 1, 1e-12);
  EXPECT_NEAR(winding_number({0.3, 0.2, 0.1}, s.positions, s.triangles), 0, 1e-12);
  test::append(s, test::capsule({0, 0.2, 0}, {0.3, 0.3, 0}, 0.1));
  EXPECT_NEAR(at_middle(), 2, 1e-12);
  test::Shape hollow = test::capsule({0, 0.2, 0}, {0, 0.3, 0}, 0.05);  // a mouth: faces into its air
  for (Triangle& t : hollow.triangles) std::swap(t[1], t[2]);
  test::append(s, hollow);
  EXPECT_NEAR(at_middle(), 1, 1e-12);
}

TEST(WindingNumber, Of_a_dome_is_one_less_the_share_of_its_lid) {
  const double radius = 0.16;
  const test::Shape s = test::dome({0, 0, 0}, radius, 60);
  // A disc of this radius at the distance h covers 2 pi (1 - h / sqrt(h2 + r2)); 24 corners are 0.4 % of a radius
  // short.
  for (const double h : {0.0, 0.02, 0.08, 0.14})
    EXPECT_NEAR(winding_number({0, h, 0}, s.positions, s.triangles), 0.5 + 0.5 * h / std::hypot(h, radius), 5e-3) << h;
  EXPECT_NEAR(winding_number({0, -0.08, 0}, s.positions, s.triangles), 0.5 - 0.5 * 0.08 / std::hypot(0.08, radius),
              5e-3);
}

TEST(WindingNumber, Of_a_dipole_tree_is_as_near_as_its_header_says) {
  for (const test::Shape& s : {test::body_of_open_shells(), test::capsule({-0.2, 0, 0}, {0.2, 0.05, 0}, 0.1)}) {
    const Field field(s);
    double error[3] = {0, 0, 0};
    for (const Vec3& p : points_about(s, 4000)) {
      const double exact = winding_number(p, s.positions, s.triangles);
      for (int k = 0; k < 3; ++k) error[k] = std::max(error[k], std::abs(field.winding.about(p, 2 << k) - exact));
    }
    EXPECT_LT(error[0], 0.08);
    EXPECT_LT(error[1], 0.017);
    EXPECT_LT(error[2], 2e-3);
  }
}

TEST(WindingNumber, Tells_inside_as_if_all_triangles_had_been_asked) {
  const test::Shape s = test::body_of_open_shells();
  const Field field(s);
  int inside = 0, near_a_lid = 0;
  std::vector<Vec3> points = points_about(s, 6000);
  for (int k = 0; k < 2000; ++k)  // about the lids of the dome and of the tube, where it is decided by little
    points.push_back(k % 2 == 0 ? Vec3(0.16e-3 * (k - 1000), 0.8 + 3e-6 * k, 1e-3)
                                : Vec3(0.3 + 0.07e-3 * (k - 1000), 0.2 + 1e-5 * (k - 1000), 1e-3));
  for (const Vec3& p : points) {
    const double w = std::abs(winding_number(p, s.positions, s.triangles));
    if (std::abs(w - 0.5) < 1e-9) continue;  // rounding decides
    inside += w > 0.5;
    near_a_lid += std::abs(w - 0.5) < 0.01;
    ASSERT_EQ(field.winding.is_inside(p), w > 0.5) << p.transpose() << " " << w;
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(near_a_lid, 20);
}

TEST(WindingNumber, Does_not_depend_on_which_way_the_surface_faces) {
  test::Shape s = test::body_of_open_shells(), turned = s;
  for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
  const Field field(s), other(turned);
  for (const Vec3& p : points_about(s, 1000)) {
    EXPECT_EQ(field.winding.is_inside(p), other.winding.is_inside(p));
    EXPECT_NEAR(field.winding.about(p), -other.winding.about(p), 1e-12);
  }
}

TEST(WindingNumber, Of_triangles_without_area_and_at_their_corners_is_a_number) {
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 1, 3}, Triangle{0, 0, 1}, Triangle{2, 2, 2}}) {
    const std::vector<Triangle> triangles{t};
    const TriangleTree tree(x, triangles);
    const WindingTree winding(tree, x, triangles);
    for (const Vec3& base : {x[0], Vec3(0.5, 0, 0), Vec3(0.2, 0.2, 0)})
      for (const double off : {0.0, 1e-12, -1e-12}) {
        const Vec3 p = base + off * Vec3::UnitZ();
        EXPECT_LE(std::abs(winding_number(p, x, triangles)), 0.5);
        EXPECT_FALSE(winding.is_inside(p));
      }
  }
  EXPECT_EQ(winding_number({0, 0, 0}, x, {}), 0);
  const TriangleTree none;
  EXPECT_FALSE(WindingTree(none, x, {}).is_inside({0, 0, 0}));
}

}  // namespace
}  // namespace ft

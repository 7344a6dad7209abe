// The tailor of the samples on bodies whose measures are known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/shot/mesh_file.h"
#include "samples/tools/body_slices.h"
#include "samples/tools/distance_grid.h"
#include "samples/tools/garment_check.h"
#include "samples/tools/skirt.h"
#include "samples/tools/top.h"

namespace ft::garments {
namespace {

/// A closed tube of given radii along a straight line, capped with points.
void add_tube(Body& body, const Vec3& from, const Vec3& to, const std::vector<double>& radii) {
  const Vec3 axis = (to - from).normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  const int around = 48, rings = static_cast<int>(radii.size()), base = static_cast<int>(body.positions.size());
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      body.positions.push_back(from + (to - from) * r / (rings - 1) +
                               radii[static_cast<std::size_t>(r)] * (std::cos(angle) * u + std::sin(angle) * v));
    }
  body.positions.push_back(from);
  body.positions.push_back(to);
  for (int k = 0; k < around; ++k) {
    const int n = (k + 1) % around, last = base + (rings - 1) * around;
    body.triangles.push_back({base + rings * around, base + n, base + k});
    body.triangles.push_back({base + rings * around + 1, last + k, last + n});
    for (int r = 0; r + 1 < rings; ++r) {
      const int a = base + r * around, b = a + around;
      body.triangles.push_back({a + k, a + n, b + n});
      body.triangles.push_back({a + k, b + n, b + k});
    }
  }
}

/// 1.7 m tall, of overlapping tubes: legs to 0.85, torso to 1.4 (narrowest at 1.10), neck and head above, arms to the
/// sides.
Body doll() {
  Body body;
  add_tube(body, Vec3(0.1, 0, 0), Vec3(0.1, 0.9, 0), {0.07, 0.07, 0.07, 0.07});
  add_tube(body, Vec3(-0.1, 0, 0), Vec3(-0.1, 0.9, 0), {0.07, 0.07, 0.07, 0.07});
  add_tube(body, Vec3(0, 0.80, 0), Vec3(0, 1.40, 0), {0.19, 0.19, 0.15, 0.12, 0.15, 0.16, 0.12});
  add_tube(body, Vec3(0, 1.35, 0), Vec3(0, 1.70, 0), {0.05, 0.05, 0.09, 0.08});
  add_tube(body, Vec3(-0.7, 1.30, 0), Vec3(0.7, 1.30, 0), {0.04, 0.04, 0.04, 0.05, 0.05, 0.04, 0.04, 0.04});
  return body;
}

TEST(Garments, Landmarks_of_a_doll_are_found) {
  const auto shape = measure_body(doll(), 0);
  ASSERT_TRUE(shape.ok());
  EXPECT_NEAR(shape->bounds.size().y(), 1.70, 1e-9);
  // The slices are 1.70 / 350 apart and the cells 5 mm wide: a centimetre is what can be asked.
  EXPECT_NEAR(shape->waist, 1.10, 0.02);
  EXPECT_NEAR(shape->crotch, 0.80, 0.01);
  EXPECT_GT(shape->neck_base, 1.30);
  EXPECT_LT(shape->neck_base, 1.45);
  EXPECT_NEAR(shape->slice_at(0.85).area, std::numbers::pi * 0.19 * 0.19, 0.02 * std::numbers::pi * 0.19 * 0.19);
}

TEST(Garments, Hands_beside_the_hips_are_not_hips) {
  Body body = doll();
  add_tube(body, Vec3(0.4, 0.7, 0), Vec3(0.4, 1.2, 0), {0.04, 0.04, 0.04});
  const auto shape = measure_body(body, 0);
  ASSERT_TRUE(shape.ok());
  EXPECT_LT(shape->slice_at(0.95).width_x, 0.40);
}

TEST(Garments, Skirt_clears_the_body_and_can_be_simulated) {
  const Body body = doll();
  const auto shape = measure_body(body, 0);
  ASSERT_TRUE(shape.ok());
  SkirtSettings settings;
  const Mesh skirt = make_skirt(*shape, settings);
  EXPECT_EQ(skirt.vertex_count(), settings.rings * settings.segments);
  EXPECT_TRUE(check_garment(skirt).ok());
  const auto triangles = triangulate(skirt);
  EXPECT_TRUE(fit_of(skirt.positions, triangles, body).clear());
  // The waist ring lies 8 mm off; rounding off takes a little and half a cell is added.
  for (int k = 0; k < settings.segments; ++k) {
    const Vec3& p = skirt.positions[static_cast<std::size_t>(k)];
    const double gap = std::hypot(p.x(), p.z()) - 0.12;
    EXPECT_GT(gap, 5e-3);
    EXPECT_LT(gap, 30e-3);
  }
  EXPECT_GT(shape_quality(skirt.positions, triangles).smallest_angle_deg, 15);
  ASSERT_EQ(skirt.groups.size(), 1u);
  EXPECT_EQ(skirt.groups[0].name, "waist");
  EXPECT_EQ(static_cast<int>(skirt.groups[0].vertices.size()), 2 * settings.segments);
}

TEST(Garments, Skirt_faces_outwards) {
  const auto shape = measure_body(doll(), 0);
  ASSERT_TRUE(shape.ok());
  const Mesh skirt = make_skirt(*shape, {});
  const auto normals = vertex_normals(skirt.positions, triangulate(skirt));
  for (std::size_t v = 0; v < normals.size(); ++v)
    EXPECT_GT(normals[v].dot(Vec3(skirt.positions[v].x(), 0, skirt.positions[v].z())), 0) << "vertex " << v;
}

TEST(Garments, Top_clears_the_body_has_four_openings_and_faces_outwards) {
  const Body body = doll();
  const auto shape = measure_body(body, 0);
  ASSERT_TRUE(shape.ok());
  const auto top = make_top(body, *shape, {});
  ASSERT_TRUE(top.ok()) << top.error().text();
  EXPECT_TRUE(check_garment(*top).ok());
  const auto triangles = triangulate(*top);
  EXPECT_TRUE(fit_of(top->positions, triangles, body).clear());
  EXPECT_GT(shape_quality(top->positions, triangles).smallest_angle_deg, 3);
  // A sphere with four holes: V - E + F = 2 - 4.
  const int euler =
      top->vertex_count() - static_cast<int>(unique_edges(triangles).size()) + static_cast<int>(triangles.size());
  EXPECT_EQ(euler, -2);
  const auto normals = vertex_normals(top->positions, triangles);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vec3& p = top->positions[v];
    if (std::abs(p.x()) < 0.15 && p.y() < 1.25) {
      EXPECT_GT(normals[v].dot(Vec3(p.x(), 0, p.z())), 0) << "vertex " << v;
    }
  }
}

TEST(Garments, Turned_body_gets_its_arms_along_x) {
  Body body = doll();
  const Eigen::AngleAxisd turn(0.7, Vec3::UnitY());
  for (Vec3& p : body.positions) p = turn * p;
  const Eigen::Isometry3d back = arms_along_x(body);
  Box box;
  for (const Vec3& p : body.positions) box.include(back * p);
  EXPECT_NEAR(box.size().x(), 1.4, 0.01);
}

TEST(Garments, Distance_grid_agrees_with_a_sphere) {
  Body body;
  std::vector<double> radii;
  for (int k = 0; k <= 40; ++k) radii.push_back(std::sqrt(std::max(1e-6, 0.01 - std::pow(0.2 * k / 40 - 0.1, 2))));
  add_tube(body, Vec3(0, -0.1, 0), Vec3(0, 0.1, 0), radii);
  Box box;
  box.lo = Vec3::Constant(-0.15), box.hi = Vec3::Constant(0.15);
  const DistanceGrid grid = make_distance_grid(body, box, 0.01, 0.08);
  for (int z = 0; z < grid.size[2]; ++z)
    for (int y = 0; y < grid.size[1]; ++y)
      for (int x = 0; x < grid.size[0]; ++x) {
        const double exact = grid.node(x, y, z).norm() - 0.1;
        if (std::abs(exact) > 0.07) continue;
        // 48 corners around and 40 rings: the facets lie up to 0.1 (1 - cos(pi / 48)) + the caps' 2.5 mm inside.
        EXPECT_NEAR(grid.values[static_cast<std::size_t>(grid.index(x, y, z))], exact, 2.5e-3);
      }
}

TEST(Garments, Fit_counts_crossings_depth_and_gap) {
  const Body body = doll();
  const auto shape = measure_body(body, 0);
  ASSERT_TRUE(shape.ok());
  Mesh skirt = make_skirt(*shape, {});
  const auto triangles = triangulate(skirt);
  const Fit clear = fit_of(skirt.positions, triangles, body);
  EXPECT_TRUE(clear.clear());
  EXPECT_GT(clear.gap, 5e-3);
  EXPECT_EQ(clear.text(), "");
  for (Vec3& p : skirt.positions) p.x() += 0.05;  // the waist's cloth is 8 mm off at its 120 mm
  const Fit shifted = fit_of(skirt.positions, triangles, body);
  EXPECT_GT(shifted.crossings, 10);
  EXPECT_GT(shifted.inside, 10);
  EXPECT_NEAR(shifted.depth, 0.04, 8e-3);
  EXPECT_LT(skirt.positions[static_cast<std::size_t>(shifted.worst)].x(), 0);
}

TEST(Garments, Skirt_that_is_a_little_in_the_body_is_moved_out_of_it) {
  const Body body = doll();
  const auto shape = measure_body(body, 0);
  ASSERT_TRUE(shape.ok());
  Mesh skirt = make_skirt(*shape, {});
  const auto triangles = triangulate(skirt);
  for (Vec3& p : skirt.positions) p.x() += 0.02;
  ASSERT_FALSE(fit_of(skirt.positions, triangles, body).clear());
  const std::vector<Vec3> before = skirt.positions;
  const Fit fit = move_out(skirt.positions, triangles, body, 8e-3, 3e-3);
  EXPECT_TRUE(fit.clear()) << fit.text();
  EXPECT_GE(fit.gap, 3e-3);
  double farthest = 0;
  for (std::size_t v = 0; v < before.size(); ++v)
    farthest = std::max(farthest, (skirt.positions[v] - before[v]).norm());
  EXPECT_LT(farthest, 0.03);
  EXPECT_GT(shape_quality(skirt.positions, triangles).smallest_angle_deg, 8);
}

TEST(Garments, Skirt_passes_between_hips_and_hands) {
  Body body = doll();
  for (const double side : {-1.0, 1.0})
    add_tube(body, Vec3(side * 0.265, 0.7, 0), Vec3(side * 0.265, 1.25, 0), {0.04, 0.04, 0.04});
  const auto shape = measure_body(body, 0);
  ASSERT_TRUE(shape.ok());
  SkirtSettings settings;
  settings.flare = 0.2;
  Mesh skirt = make_skirt(*shape, settings);
  const auto triangles = triangulate(skirt);
  EXPECT_FALSE(fit_of(skirt.positions, triangles, body).clear());
  settings.within_arms = true;
  skirt = make_skirt(*shape, settings);
  const Fit fit = fit_of(skirt.positions, triangles, body);
  EXPECT_TRUE(fit.clear()) << fit.text();
  EXPECT_GT(fit.gap, 5e-3);
  for (const Vec3& p : skirt.positions)  // none of it is on the hands' other side
    if (p.y() > 0.72) {
      EXPECT_LT(std::abs(p.x()), 0.24);
    }
}

TEST(Garments, Torso_behind_a_card_and_under_a_dome_is_found_as_without_them) {
  Body body = doll();
  const auto alone = measure_body(body, 0);
  // Hair cards beside the hips and a cape's collar: open, and no torso.
  for (const double x : {0.35, -0.35}) {
    const int base = static_cast<int>(body.positions.size());
    for (const Vec2& corner : {Vec2(-0.1, 0.6), Vec2(0.1, 0.6), Vec2(0.1, 1.25), Vec2(-0.1, 1.25)})
      body.positions.push_back({x, corner.y(), corner.x()});
    body.triangles.push_back({base, base + 1, base + 2});
    body.triangles.push_back({base, base + 2, base + 3});
  }
  const auto shape = measure_body(body, 0);
  ASSERT_TRUE(alone.ok() && shape.ok());
  EXPECT_EQ(shape->waist, alone->waist);
  EXPECT_EQ(shape->crotch, alone->crotch);
  EXPECT_EQ(shape->slice_at(0.95).area, alone->slice_at(0.95).area);
}

}  // namespace
}  // namespace ft::garments

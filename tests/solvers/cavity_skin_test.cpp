// The surface's mesh around cavities.
#include "solvers/water/cavity_skin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "solvers/water/pond/pond_core.h"
#include "solvers/water/pond/pond_setup.h"
#include "solvers/water/water_solver.h"
#include "tests/solvers/pond_scenes.h"

namespace ft::test {
namespace {

constexpr double k_slice = 0.05;  // m

WaterGrid square_grid(double cell) {
  const int n = static_cast<int>(std::lround(8 / cell));
  return {Vec2(-4, -4), cell, n, n};
}

/// A tube of air from the level down; radius by depth, below zero: closed there.
template <class Radius>
WaterCavity tube(double depth, const Vec2& place, const Radius& radius) {
  WaterCavity out{0};
  for (double d = 0.5 * k_slice; d < depth; d += k_slice)
    if (radius(d) > 0) out.discs.push_back({Vec3(place.x(), -d, place.y()), radius(d), k_slice});
  return out;
}

struct Drawn {
  Mesh mesh;
  std::vector<DrawnIn> moved;
};
Drawn drawn(const WaterGrid& grid, const std::vector<WaterCavity>& cavities, double level = 0) {
  Drawn out{water_mesh("water", grid, level), {}};
  out.moved = draw_in(grid, std::vector<double>(out.mesh.positions.size(), level), cavities);
  for (const DrawnIn& v : out.moved) out.mesh.positions[v.vertex] = v.place;
  return out;
}

/// Between y = 0 and the surface, above zero where that is lower.
double hollow(const Mesh& mesh) {
  double out = 0;
  for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
    const auto corner = [&](std::size_t c) { return mesh.positions[at(mesh.face_vertices[4 * f + c])]; };
    for (const std::size_t c : {1u, 2u}) {
      const Vec3 a = corner(0), b = corner(c), d = corner(c + 1);
      out -= (a.y() + b.y() + d.y()) / 6 * ((b.z() - a.z()) * (d.x() - a.x()) - (b.x() - a.x()) * (d.z() - a.z()));
    }
  }
  return out;
}

TEST(CavitySkin, Has_the_volume_of_the_air) {
  const WaterCavity well = tube(1, Vec2(0.31, -0.22), [](double) { return 0.3; });
  const WaterCavity cone = tube(0.6, Vec2(0.3, 0), [](double d) { return 0.4 - 0.6 * d; });
  for (const WaterCavity& cavity : {well, cone}) {
    double air = 0;
    for (const AirDisc& disc : cavity.discs) air += std::numbers::pi * disc.radius * disc.radius * disc.thickness;
    const double coarse = hollow(drawn(square_grid(0.05), {cavity}).mesh),
                 fine = hollow(drawn(square_grid(0.0125), {cavity}).mesh);
    EXPECT_NEAR(coarse / air, 1, 0.06);
    EXPECT_NEAR(fine / air, 1, 0.02);
  }
}

TEST(CavitySkin, Draws_in_what_is_around_and_nothing_else) {
  const WaterGrid grid = square_grid(0.05);
  const Drawn hole = drawn(grid, {tube(1, Vec2(0.31, -0.22), [](double) { return 0.3; })});
  const Mesh before = water_mesh("water", grid, 0);
  std::set<std::size_t> moved;
  double deepest = 0;
  for (const DrawnIn& v : hole.moved) {
    EXPECT_TRUE(moved.insert(v.vertex).second) << "once each";
    const Vec3& from = before.positions[v.vertex];
    const Vec2 axis(0.31, -0.22), was = Vec2(from.x(), from.z()) - axis, is = Vec2(v.place.x(), v.place.z()) - axis;
    if (v.on_wall) {
      EXPECT_LT(is.norm(), 0.36);
      EXPECT_LE(v.place.y(), 1e-12);
    } else {
      EXPECT_GT(is.norm(), 0.3 - 1e-9);
      EXPECT_EQ(v.place.y(), 0);
    }
    EXPECT_LT(is.lpNorm<Eigen::Infinity>(), was.lpNorm<Eigen::Infinity>() + 0.4);
    deepest = std::min(deepest, v.place.y());
  }
  EXPECT_NEAR(deepest, -1, 1e-9);
  // No face is folded over another on the level, and none is turned over.
  for (std::size_t f = 0; f < hole.mesh.face_sizes.size(); ++f) {
    Vec3 normal = Vec3::Zero();
    for (const int c : {1, 2}) {
      const auto corner = [&](int k) { return hole.mesh.positions[at(hole.mesh.face_vertices[4 * f + at(k)])]; };
      normal += (corner(c) - corner(0)).cross(corner(c + 1) - corner(0));
    }
    EXPECT_GT(normal.y(), -1e-6);
    EXPECT_GT(normal.norm(), 1e-9);
  }
}

TEST(CavitySkin, Grows_and_closes_without_jumps) {
  const WaterGrid grid = square_grid(0.05);
  // What is 1 mm wider, or whose neck is 1 mm narrower, has no vertex more than a few of them elsewhere.
  const auto neck = [&](double narrow) {
    return tube(1, Vec2(0.31, -0.22), [&](double d) { return 0.3 - narrow * std::exp(-std::pow((d - 0.5) / 0.1, 2)); });
  };
  const auto farthest = [&](const WaterCavity& a, const WaterCavity& b) {
    const Mesh x = drawn(grid, {a}).mesh, y = drawn(grid, {b}).mesh;
    double out = 0;
    for (std::size_t v = 0; v < x.positions.size(); ++v) out = std::max(out, (x.positions[v] - y.positions[v]).norm());
    return out;
  };
  for (const double r : {0.05, 0.1, 0.2, 0.3}) {
    const auto wide = [&](double radius) { return tube(1, Vec2(0.31, -0.22), [&](double) { return radius; }); };
    EXPECT_LT(farthest(wide(r), wide(r + 1e-3)), 8e-3) << r;
  }
  EXPECT_LT(farthest(neck(0.1), neck(0.101)), 8e-3);
  EXPECT_LT(farthest(neck(0.299), neck(0.2999)), 8e-3);
}

TEST(CavitySkin, Waves_go_on_over_the_rim) {
  const WaterGrid grid = square_grid(0.05);
  const Mesh flat = water_mesh("water", grid, 0);
  std::vector<double> heights;
  for (const Vec3& p : flat.positions) heights.push_back(0.1 + 0.05 * p.x());
  const WaterCavity cavity = tube(1, Vec2(0.31, -0.22), [](double) { return 0.3; });
  for (const DrawnIn& v : draw_in(grid, heights, std::vector{cavity})) {
    const double wave = 0.1 + 0.05 * v.place.x();
    if (v.on_wall)
      EXPECT_LT(v.place.y(), wave + 1e-3);
    else
      EXPECT_NEAR(v.place.y(), wave, 1e-12);
  }
}

TEST(CavitySkin, One_of_two_that_overlap_is_drawn_and_none_at_the_rim) {
  const WaterGrid grid = square_grid(0.05);
  const auto at_place = [](double x, double depth) { return tube(depth, Vec2(x, 0), [](double) { return 0.2; }); };
  const auto lowest = [&](const std::vector<WaterCavity>& cavities) {
    double out = 0;
    for (const DrawnIn& v : drawn(grid, cavities).moved) out = std::min(out, v.place.y());
    return out;
  };
  EXPECT_NEAR(lowest({at_place(0, 0.5), at_place(0.3, 1)}), -1, 1e-9);
  EXPECT_EQ(drawn(grid, {at_place(0, 0.5), at_place(0.3, 1)}).moved.size(),
            drawn(grid, {at_place(0.3, 1)}).moved.size());
  EXPECT_GT(drawn(grid, {at_place(-2, 0.5), at_place(2, 1)}).moved.size(), drawn(grid, {at_place(2, 1)}).moved.size());
  EXPECT_TRUE(drawn(grid, {at_place(3.9, 1)}).moved.empty());
  EXPECT_TRUE(drawn(grid, {at_place(5, 1)}).moved.empty());
}

TEST(CavitySkin, What_dives_into_a_pond_leaves_a_hole_as_large_as_the_account_says) {
  PondSetup setup = square_pond(8, 160, 5);
  setup.splash.cavity_opening = 0.06;
  auto core = pond_core(std::move(setup));
  ASSERT_TRUE(core);
  // A slim body of 1 m, upright, at 8 m/s.
  TriangleSurface body = capsule_surface(0.15, 0.7, 3);
  const auto at_height = [&](double y) {
    std::vector<Vec3> out = body.positions;
    const auto box = bounds(out);
    for (Vec3& p : out)
      p += Vec3(4, y - box.lo.y(), 4) - Vec3(0.5 * (box.lo.x() + box.hi.x()), 0, 0.5 * (box.lo.z() + box.hi.z()));
    return out;
  };
  const WaterGrid grid = (*core)->grid();
  State state = (*core)->initial_state();
  int seen = 0;
  double most = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const double time = 1.0 / 48, y = 0.2 - 8 * frame * time;
    const std::vector<Vec3> from = at_height(y), to = at_height(y - 8 * time);
    const DrivenBody driven{body.triangles, from, to};
    (*core)->advance(state, time, std::span(&driven, 1));
    const std::vector<WaterCavity> cavities = (*core)->cavities(state);
    if (cavities.empty()) continue;
    double air = 0, deep = 0;
    for (const AirDisc& disc : cavities[0].discs) {
      air += std::numbers::pi * disc.radius * disc.radius * disc.thickness;
      deep = std::max(deep, cavities[0].level - disc.centre.y() + 0.5 * disc.thickness);
    }
    EXPECT_NEAR(-(*core)->ledger(state).cavities / air, 1, 0.05);
    if (air < 0.01) continue;
    most = std::max(most, air);
    EXPECT_NEAR(hollow(drawn(grid, cavities).mesh), air, 0.1 * most) << frame << ": three cells across";
    ++seen;
  }
  EXPECT_GT(seen, 3);
}

}  // namespace
}  // namespace ft::test

// Bodies built on motion capture: closed, evenly meshed, human-sized, and skinned without leaks between limbs.
#include "io/import/body/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "baker/core/mesh.h"
#include "baker/core/random.h"
#include "io/import/body/surface_nets.h"
#include "io/import/import.h"
#include "io/import/import_cache.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

/// Every edge is used once in each direction.
bool is_closed(const std::vector<Triangle>& triangles) {
  std::map<Edge, int> uses;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    const auto back = uses.find({use.first[1], use.first[0]});
    return use.second == 1 && back != uses.end();
  });
}

double volume(const std::vector<Vec3>& p, const std::vector<Triangle>& triangles) {
  double v = 0;
  for (const Triangle& t : triangles)
    v += p[static_cast<std::size_t>(t[0])].dot(
             p[static_cast<std::size_t>(t[1])].cross(p[static_cast<std::size_t>(t[2])])) /
         6;
  return v;
}

/// Smallest angle of a triangle [deg].
double least_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto angle = [](const Vec3& u, const Vec3& v) {
    return std::acos(std::clamp(u.dot(v) / (u.norm() * v.norm()), -1.0, 1.0));
  };
  return std::min({angle(b - a, c - a), angle(a - b, c - b), angle(a - c, b - c)}) * 180 / M_PI;
}

const char* const k_bvh[] = {"cmu_01_playground/01_01.bvh", "animateddrawings_fair1_child/dab.bvh",
                             "animateddrawings_cmu_jacks/jumping_jacks.bvh"};

TEST(Body, Is_closed_even_and_human_sized_and_stays_so_while_it_moves_slow) {
  for (const char* name : k_bvh) {
    ImportRequest request;
    request.file = test::assets_root() / "mocap" / name;
    FT_REQUIRE_FILE(request.file);
    request.height = 1.7;
    auto primary = import_primary(request);
    ASSERT_TRUE(primary) << primary.error().text();
    const Surface& surface = primary->trajectory->surface();
    std::vector<Vec3> p(static_cast<std::size_t>(surface.vertex_count()));
    primary->trajectory->bind_pose(p);
    EXPECT_TRUE(is_closed(surface.triangles)) << name;
    EXPECT_GE(surface.triangles.size(), 10'000u) << name;
    EXPECT_LE(surface.triangles.size(), 22'000u) << name;
    EXPECT_NEAR(bounds(p).size().y(), 1.7, 1e-9);
    const double litres = 1000 * volume(p, surface.triangles);
    EXPECT_GT(litres, 35) << name;  // a slim adult of 1.7 m has 50 to 65
    EXPECT_LT(litres, 80) << name;
    int slivers = 0;
    for (const Triangle& t : surface.triangles)
      slivers += least_angle(p[static_cast<std::size_t>(t[0])], p[static_cast<std::size_t>(t[1])],
                             p[static_cast<std::size_t>(t[2])]) < 15;
    EXPECT_LT(slivers, static_cast<int>(surface.triangles.size()) / 200) << name;
    for (const double time : {0.0, 1.0, 2.5}) {
      primary->trajectory->sample(time, p);
      EXPECT_GT(1000 * volume(p, surface.triangles), 0.8 * litres) << name << " caves in at " << time;
      EXPECT_LT(1000 * volume(p, surface.triangles), 1.2 * litres) << name << " swells at " << time;
    }
  }
}

TEST(Body, Weights_do_not_leak_between_limbs_slow) {
  for (const char* name : k_bvh) {
    const auto file = test::assets_root() / "mocap" / name;
    FT_REQUIRE_FILE(file);
    auto loaded = load_character(file, {}, {});
    ASSERT_TRUE(loaded) << loaded.error().text();
    Character& c = loaded->character;
    const bool z_up = std::string(name).find("fair1") != std::string::npos;
    Mat3 axes = Mat3::Identity();
    if (z_up) axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    ASSERT_TRUE(add_body(c, "blended", axes));
    ASSERT_TRUE(check_character(c)) << check_character(c).error().text();
    const CharacterMesh& mesh = c.meshes.back();
    const auto limb = [&](int bone) {  // 1 left leg, 2 right leg, 3 left arm, 4 right arm below the shoulder, 0 others
      const std::string& n = c.nodes[static_cast<std::size_t>(mesh.bones[static_cast<std::size_t>(bone)].node)].name;
      const bool left = n.starts_with("L") || n.starts_with("l"), right = n.starts_with("R") || n.starts_with("r");
      if (n.find("Leg") != std::string::npos || n.find("Foot") != std::string::npos ||
          n.find("Knee") != std::string::npos || n.find("Ankle") != std::string::npos)
        return n.find("UpLeg") != std::string::npos ? 0 : left ? 1 : 2;
      if (n.find("ForeArm") != std::string::npos || n.find("Hand") != std::string::npos ||
          n.find("Elbow") != std::string::npos || n.find("Wrist") != std::string::npos)
        return left ? 3 : right ? 4 : 0;
      return 0;
    };
    int of_limb[5] = {};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      bool seen[5] = {};
      for (int k = mesh.influence_start[v]; k < mesh.influence_start[v + 1]; ++k)
        seen[limb(mesh.influence_bone[static_cast<std::size_t>(k)])] = true;
      EXPECT_LE(seen[1] + seen[2] + seen[3] + seen[4], 1) << name << " vertex " << v;
      EXPECT_FALSE((seen[3] || seen[4]) && (seen[1] || seen[2]));
      for (int l = 1; l < 5; ++l) of_limb[l] += seen[l];
    }
    for (int l = 1; l < 5; ++l) EXPECT_GT(of_limb[l], 300) << name;
  }
}

TEST(Body, Capsules_are_closed_shells_one_for_each_bone) {
  ImportRequest request;
  request.file = test::assets_root() / "mocap" / k_bvh[0];
  FT_REQUIRE_FILE(request.file);
  request.body = "capsules";
  auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  const Surface& surface = primary->trajectory->surface();
  EXPECT_TRUE(is_closed(surface.triangles));
  for (const Triangle& t : surface.triangles) {
    EXPECT_EQ(surface.part_of_vertex[static_cast<std::size_t>(t[0])],
              surface.part_of_vertex[static_cast<std::size_t>(t[1])]);
    EXPECT_EQ(surface.part_of_vertex[static_cast<std::size_t>(t[0])],
              surface.part_of_vertex[static_cast<std::size_t>(t[2])]);
  }
}

TEST(Body, A_skeleton_without_height_is_refused) {
  Character c;
  c.format = "BVH";
  c.nodes = {{"Hips", -1, Mat4::Identity(), {}}};
  EXPECT_FALSE(add_body(c, "blended", Mat3::Identity()));
  EXPECT_FALSE(add_body(c, "capsules", Mat3::Identity()));
}

TEST(Surface_nets, Are_closed_for_any_field_once_sheets_are_apart) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {  // noise: every ambiguous cell there is
    FieldGrid grid;
    grid.nx = grid.ny = grid.nz = 12;
    for (int i = 0; i < 12 * 12 * 12; ++i) {
      const int x = i % 12, y = i / 12 % 12, z = i / 144;
      const bool border = x == 0 || y == 0 || z == 0 || x == 11 || y == 11 || z == 11;
      grid.values.push_back(
          border ? 1 : random_uniform({seed}, static_cast<std::uint64_t>(i)) - 0.1 * static_cast<double>(seed % 9));
    }
    separate_sheets(grid);
    const NetSurface net = surface_nets(grid);
    std::vector<Triangle> triangles;
    for (const auto& q : net.quads) triangles.push_back({q[0], q[1], q[2]}), triangles.push_back({q[0], q[2], q[3]});
    EXPECT_TRUE(triangles.empty() || is_closed(triangles)) << seed;
    EXPECT_TRUE(triangles.empty() || volume(net.positions, triangles) > 0) << "inside out";
  }
}

TEST(Surface_nets, Enclose_a_sphere) {
  FieldGrid grid;
  grid.nx = grid.ny = grid.nz = 41;
  grid.spacing = 0.06, grid.origin = Vec3::Constant(-1.2);
  for (int z = 0; z < 41; ++z)
    for (int y = 0; y < 41; ++y)
      for (int x = 0; x < 41; ++x) grid.values.push_back(grid.point(x, y, z).norm() - 1);
  const NetSurface net = surface_nets(grid);
  std::vector<Triangle> triangles;
  for (const auto& q : net.quads) triangles.push_back({q[0], q[1], q[2]}), triangles.push_back({q[0], q[2], q[3]});
  EXPECT_TRUE(is_closed(triangles));
  for (const Vec3& p : net.positions) EXPECT_NEAR(p.norm(), 1, 0.5 * grid.spacing * grid.spacing * 2);
  EXPECT_NEAR(volume(net.positions, triangles), 4.0 / 3 * M_PI, 0.02);
}

}  // namespace
}  // namespace ft

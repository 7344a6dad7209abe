// A surface whose vertices are drawn into a cavity, as a level set.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>

#include "baker/core/file.h"
#include "io/volume/openvdb_write.h"
#include "tests/support/assets.h"

namespace ft::test {
namespace {

constexpr double k_cell = 0.1, k_half = 0.15, k_depth = 0.6;  // m

/// Still water of 2 m with a square well in the middle, into which three rings of vertices are drawn.
LiquidFrame with_a_well() {
  LiquidFrame out;
  out.across = out.along = 21;
  out.voxel = 0.025, out.floor = -1, out.fps = 24;
  for (int k = -10; k <= 10; ++k)
    for (int i = -10; i <= 10; ++i) {
      const int ring = std::max(std::abs(i), std::abs(k));
      const double wide = ring == 0 || ring > 3 ? k_cell : k_half / ring;
      const double y = ring > 3 ? 0 : -k_depth * std::min(1.0, 0.5 * (3 - ring));
      out.surface.emplace_back(static_cast<float>(wide * i), static_cast<float>(y), static_cast<float>(wide * k));
      // The wall goes outwards, its bottom and what is around stand still.
      const double speed = ring == 2 || ring == 3 ? 1.5 : 0;
      out.velocities.emplace_back(static_cast<float>(std::abs(i) == ring ? std::copysign(speed, i) : 0), 0, 0);
      out.foam.push_back(ring > 3 ? 0.5f : 0.0f);
    }
  return out;
}

openvdb::GridPtrVec grids_of(const std::filesystem::path& path) {
  openvdb::io::File file(path.string());
  file.open();
  return *file.getGrids();
}

template <class Grid>
typename Grid::Ptr find(const openvdb::GridPtrVec& grids, const char* name) {
  for (const auto& grid : grids)
    if (grid->getName() == name) return openvdb::gridPtrCast<Grid>(grid);
  return {};
}

TEST(LiquidVdb, A_cavity_is_air) {
  const ScratchFolder folder;
  const LiquidFrame water = with_a_well();
  ASSERT_TRUE(write_liquid_vdb(folder / "a.vdb", water));
  const auto grids = grids_of(folder / "a.vdb");
  const auto surface = find<openvdb::FloatGrid>(grids, "surface");
  ASSERT_TRUE(surface);
  // Nearer than the well's corners, which two triangles cut off.
  const double band = 2 * water.voxel;
  auto to = surface->getConstAccessor();
  int compared = 0;
  for (int iy = -39; iy < 3; ++iy)
    for (int ix = -36; ix <= 36; ++ix)
      for (const int iz : {0, 1}) {
        const double x = std::abs(ix * water.voxel), y = iy * water.voxel;
        // Through the middle: the nearest of the level, the wall and the bottom.
        double wanted = 0;
        if (x < k_half)
          wanted = y < -k_depth ? std::max(y + k_depth, -1 - y) : std::min(k_half - x, y + k_depth);
        else if (y < 0)
          wanted = std::max(std::max(y, y < -k_depth ? -std::hypot(x - k_half, y + k_depth) : k_half - x), -1 - y);
        else
          wanted = y;
        if (x < k_half && y > 0) continue;  // above the hole: from the rim
        EXPECT_NEAR(std::clamp<double>(to.getValue({ix, iy, iz}), -band, band), std::clamp(wanted, -band, band), 2e-5)
            << x << ' ' << y;
        ++compared;
      }
  EXPECT_GT(compared, 5000);
}

TEST(LiquidVdb, A_cavity_has_the_velocity_and_the_foam_of_its_wall) {
  const ScratchFolder folder;
  const LiquidFrame water = with_a_well();
  ASSERT_TRUE(write_liquid_vdb(folder / "a.vdb", water));
  const auto grids = grids_of(folder / "a.vdb");
  const auto velocity = find<openvdb::Vec3SGrid>(grids, "vel");
  const auto foam = find<openvdb::FloatGrid>(grids, "foam");
  ASSERT_TRUE(velocity && foam);
  const auto at_place = [&](double x, double y) {
    return velocity->getConstAccessor().getValue(openvdb::Coord::round(openvdb::Vec3d(x, y, 0) / water.voxel));
  };
  EXPECT_NEAR(at_place(k_half, -0.15).x(), 1.5, 1e-5);
  EXPECT_NEAR(at_place(-k_half, -0.15).x(), -1.5, 1e-5);
  // As far as it comes in half a frame, beyond the band of the level set.
  EXPECT_NEAR(at_place(k_half + 0.1, -0.2).x(), 1.5, 1e-5);
  EXPECT_EQ(at_place(0, -k_depth).x(), 0);
  const auto foam_at = [&](double x, double y) {
    return foam->getConstAccessor().getValue(openvdb::Coord::round(openvdb::Vec3d(x, y, 0) / water.voxel));
  };
  EXPECT_NEAR(foam_at(0.8, 0), 0.5, 1e-5) << "beside";
  EXPECT_NEAR(foam_at(0.4, 0), 0.5, 1e-5) << "around";
  EXPECT_EQ(foam_at(k_half, -0.3), 0) << "on the wall";
}

TEST(LiquidVdb, A_cavity_has_the_same_bytes_every_time) {
  const ScratchFolder folder;
  for (const char* name : {"a.vdb", "b.vdb"}) ASSERT_TRUE(write_liquid_vdb(folder / name, with_a_well()));
  const auto a = read_file(folder / "a.vdb"), b = read_file(folder / "b.vdb");
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(*a == *b);
}

}  // namespace
}  // namespace ft::test

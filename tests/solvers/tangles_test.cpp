// Cloth that crosses cloth where the shot starts: the walk keeps its pace, says so, and cloth holds cloth again once it is out.
#include <gtest/gtest.h>

#include "solvers/cloth/cloth_solver.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

ClothGarment strip(const char* name, const Vec3& middle, double size, int cells, bool upright) {
  ClothGarment out;
  out.name = name;
  out.mesh = make_sheet(size, cells, 0);
  for (Vec3& p : out.mesh.positions) p = middle + (upright ? Vec3(p.x(), p.z(), 0) : p);
  return out;
}

/// A sheet held by its rim, and a smaller one upright with its upper edge `above` it.
ClothSetup sheet_through_sheet(double above) {
  ClothSetup setup;
  setup.preroll_frames = 0;
  ClothGarment floor = strip("floor", Vec3::Zero(), 0.6, 20, false);
  ClothPin rim;
  for (int i = 0; i < 21 * 21; ++i)
    if (i % 21 == 0 || i % 21 == 20 || i / 21 == 0 || i / 21 == 20) rim.vertices.push_back(i);
  floor.pins.push_back(rim);
  setup.garments.push_back(std::move(floor));
  setup.garments.push_back(strip("strip", Vec3(3e-3, above - 0.1, 4e-3), 0.2, 10, true));
  return setup;
}

TEST(Tangles, do_not_slow_the_walk_down_and_are_named) {
  auto solver = make_cloth_solver(sheet_through_sheet(0.1));
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  int untangled = 0;
  for (int f = 0; f < 4; ++f) {
    const FrameReport r = (*solver)->advance_frame(state);
    EXPECT_TRUE(r.finite);
    EXPECT_LE(r.substeps, 8) << r.frame;
    EXPECT_EQ(r.rewinds, 0) << r.frame;
    EXPECT_LT(r.strain_p99, 0.05) << r.frame;
    if (r.crossings_self == 0) ++untangled;
    EXPECT_EQ(r.incidents.empty(), r.crossings_self == 0) << r.frame;
  }
  EXPECT_LT(untangled, 4);
}

TEST(Tangles, end_when_the_cloth_has_come_out) {
  auto solver = make_cloth_solver(sheet_through_sheet(0.02));
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  FrameReport last;
  for (int f = 0; f < 8; ++f) last = (*solver)->advance_frame(state);
  EXPECT_EQ(last.crossings_self, 0);
  const std::vector<double>* tangled = state.find("tangled");
  ASSERT_TRUE(tangled);
  for (const double t : *tangled) ASSERT_EQ(t, 0);
}

}  // namespace
}  // namespace ft

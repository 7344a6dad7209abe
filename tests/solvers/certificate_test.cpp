// What a frame's report says of cloth that is where it should not be.
#include <gtest/gtest.h>

#include <set>

#include "solvers/cloth/cloth_solver.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

/// A sheet of 20 cm in a ball of 1 m that stands still, `height` above its centre.
ClothSetup sheet_in_a_ball(double height) {
  std::vector<Vec3> points;
  Surface surface;
  make_sphere(0.5, 16, 32, points, surface.triangles);
  ClothSetup setup;
  setup.primary =
      std::make_shared<ScriptedBody>(std::move(surface), std::move(points), 0.0, [](double, std::span<Vec3>) {});
  setup.preroll_frames = 0;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(0.2, 8, height);
  setup.garments.push_back(std::move(sheet));
  return setup;
}

FrameReport first_frame(ClothSetup setup) {
  auto solver = make_cloth_solver(std::move(setup));
  EXPECT_TRUE(solver);
  State state = (*solver)->initial_state();
  return (*solver)->advance_frame(state);
}

TEST(Certificate, Cloth_that_is_wholly_inside_the_body_crosses_nothing_and_is_named) {
  const FrameReport r = first_frame(sheet_in_a_ball(0));
  EXPECT_EQ(r.crossings_body, 0);
  EXPECT_EQ(r.inside_body, 81);
  ASSERT_EQ(r.incidents.size(), 1u);
  EXPECT_EQ(r.incidents[0].kind, Incident::Kind::k_penetration);
  EXPECT_EQ(r.incidents[0].text, "81 vertices are on the wrong side of the body's surface");
  EXPECT_NEAR(r.incidents[0].depth, 0.49, 0.02);
}

TEST(Certificate, Cloth_outside_the_body_is_not) {
  const FrameReport r = first_frame(sheet_in_a_ball(0.6));
  EXPECT_EQ(r.inside_body, 0);
  EXPECT_TRUE(r.incidents.empty());
}

TEST(Certificate, Crossings_are_named_from_all_over_and_with_what_is_crossed) {
  ClothSetup setup;
  setup.preroll_frames = 0;
  for (const char* name : {"flat", "upright"}) {
    ClothGarment sheet;
    sheet.name = name;
    sheet.mesh = make_sheet(0.4, 40, 0);
    for (Vec3& p : sheet.mesh.positions) p = setup.garments.empty() ? p : Vec3(p.x() + 1e-3, p.z() + 1e-3, 2e-3);
    ClothPin nailed;
    nailed.to_world = true;
    for (int v = 0; v < sheet.mesh.vertex_count(); ++v) nailed.vertices.push_back(v);
    sheet.pins.push_back(nailed);
    setup.garments.push_back(std::move(sheet));
  }
  const FrameReport r = first_frame(std::move(setup));
  ASSERT_GT(r.crossings_self, 40);
  ASSERT_EQ(r.incidents.size(), 16u);
  std::set<std::pair<std::string, int>> vertices;
  double least = 1, most = -1;
  for (const Incident& i : r.incidents) {
    vertices.insert({i.system, i.vertex});
    least = std::min(least, i.place.x()), most = std::max(most, i.place.x());
    EXPECT_EQ(i.text, i.system == "flat" ? "cloth crosses \"upright\"" : "cloth crosses \"flat\"");
  }
  EXPECT_EQ(vertices.size(), 16u);
  EXPECT_GT(most - least, 0.25);
}

}  // namespace
}  // namespace ft

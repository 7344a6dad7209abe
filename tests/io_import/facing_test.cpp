// Bodies that are inside out are turned, piece by piece, and that is said.
#include "io/import/repair/facing.h"

#include <gtest/gtest.h>

#include "baker/core/file.h"
#include "baker/core/shapes.h"
#include "baker/core/volume.h"
#include "io/import/import.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

/// Pieces beside each other; of these the triangles are turned.
TriangleSurface pieces(const std::vector<std::pair<TriangleSurface, bool>>& all) {
  TriangleSurface out;
  double x = 0;
  for (const auto& [piece, turned] : all) {
    const int first = static_cast<int>(out.positions.size());
    for (const Vec3& p : piece.positions) out.positions.push_back(p + Vec3(x, 1, 0));
    for (const Triangle& t : piece.triangles)
      out.triangles.push_back(turned ? Triangle{t[0] + first, t[2] + first, t[1] + first}
                                     : Triangle{t[0] + first, t[1] + first, t[2] + first});
    x += 3;
  }
  return out;
}

TEST(Facing, A_body_that_faces_outwards_stays_as_it_is) {
  TriangleSurface ball = sphere_surface(0.5, 3);
  const auto before = ball.triangles;
  const FacingReport report = turn_outwards(ball.positions, ball.triangles);
  EXPECT_EQ(report.piece_count, 1);
  EXPECT_EQ(report.text(), "");
  EXPECT_EQ(ball.triangles, before);
}

TEST(Facing, One_that_is_inside_out_is_turned_and_has_the_volume_of_the_other) {
  TriangleSurface ball = pieces({{sphere_surface(0.5, 3), true}});
  EXPECT_FALSE(enclosed_volume(ball.positions, ball.triangles, 0.02));
  const FacingReport report = turn_outwards(ball.positions, ball.triangles);
  EXPECT_EQ(report.text(), "its surface is inside out (its faces point into the 0.511 m3 that they enclose): turned");
  EXPECT_TRUE(enclosed_volume(ball.positions, ball.triangles, 0.02));
}

TEST(Facing, Pieces_are_turned_one_by_one) {
  const std::vector<std::pair<TriangleSurface, bool>> good = {
      {sphere_surface(0.5, 2), false}, {box_surface(Vec3(1, 0.2, 0.1)), false}, {capsule_surface(0.01, 1, 2), false}};
  auto bad = good;
  bad[1].second = bad[2].second = true;
  TriangleSurface surface = pieces(bad);
  const FacingReport report = turn_outwards(surface.positions, surface.triangles);
  EXPECT_EQ(report.piece_count, 3);
  EXPECT_EQ(report.turned_count, 2);
  EXPECT_EQ(report.text().rfind("2 of its 3 closed pieces are inside out", 0), 0u) << report.text();
  EXPECT_EQ(surface.triangles, pieces(good).triangles);
}

TEST(Facing, A_cut_at_the_neck_does_not_hide_it_and_a_sheet_has_no_inside) {
  TriangleSurface ball = pieces({{sphere_surface(0.5, 4), true}});
  ball.triangles.resize(ball.triangles.size() - 8);
  EXPECT_EQ(turn_outwards(ball.positions, ball.triangles).turned_count, 1);
  TriangleSurface sheet = pieces({{box_surface(Vec3(1, 1, 1)), true}});
  sheet.triangles.resize(2);
  EXPECT_EQ(turn_outwards(sheet.positions, sheet.triangles).piece_count, 0);
}

TEST(Facing, An_import_turns_the_surface_and_says_so) {
  const test::ScratchFolder scratch;
  const TriangleSurface ball = pieces({{sphere_surface(0.5, 2), true}});
  ASSERT_TRUE(write_obj(scratch / "ball.obj", make_triangle_mesh("ball", ball.positions, ball.triangles)).ok());
  ImportRequest request;
  request.file = scratch / "ball.obj";
  const auto imported = import_primary(request);
  ASSERT_TRUE(imported) << imported.error().text();
  ASSERT_FALSE(imported->info.notes.empty());
  EXPECT_EQ(imported->info.notes[0].rfind("its surface is inside out", 0), 0u) << imported->info.notes[0];
  std::vector<Vec3> x(ball.positions.size());
  imported->trajectory->bind_pose(x);
  EXPECT_EQ(x[5], ball.positions[5].cast<float>().cast<double>());
  EXPECT_TRUE(enclosed_volume(x, imported->trajectory->surface().triangles, 0.02));
}

}  // namespace
}  // namespace ft

// Previews: a coarser garment moves, and the given one is answered for.
#include <gtest/gtest.h>

#include "baker/core/parallel.h"
#include "solvers/cloth/coarse_garment.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

/// A sheet that is pinned at one side and swings down beside a ball; maps and pattern coordinates included.
ClothSetup swinging_sheet(double coarsen) {
  Surface surface;
  std::vector<Vec3> points;
  make_sphere(0.15, 16, 24, points, surface.triangles);
  surface.part_of_vertex.resize(points.size(), 0);
  surface.parts.push_back({"ball", -1, 1.0});
  for (Vec3& p : points) p += Vec3(0, -0.35, 0);
  ClothSetup setup;
  setup.primary = std::make_shared<ScriptedBody>(surface, points, 0.0, [](double, std::span<Vec3>) {});
  setup.preroll_frames = 0;
  setup.coarsen = coarsen;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(0.6, 40, 0);
  ClothPin pin;
  for (int v = 0; v < sheet.mesh.vertex_count(); ++v)
    if (sheet.mesh.positions[at(v)].x() < -0.2999) pin.vertices.push_back(v), pin.weights.push_back(1);
  sheet.pins.push_back(pin);
  for (const Vec3& p : sheet.mesh.positions) sheet.maps.bend.push_back(1 + p.z());
  setup.garments.push_back(std::move(sheet));
  return setup;
}

std::vector<Vec3> after(const ClothSetup& setup, int frames) {
  auto solver = make_cloth_solver(setup);
  EXPECT_TRUE(solver);
  State state = (*solver)->initial_state();
  for (int f = 0; f < frames; ++f) {
    const FrameReport report = (*solver)->advance_frame(state);
    EXPECT_EQ(report.crossings_body + report.crossings_self, 0) << f;
    EXPECT_TRUE(report.finite);
  }
  std::vector<Vec3> x(setup.garments[0].mesh.positions.size());
  (*solver)->system_positions(state, 0, x);
  return x;
}

TEST(CoarseSolver, A_quarter_of_the_vertices_move_and_pins_and_maps_go_with_them) {
  const ClothGarment fine = swinging_sheet(1).garments[0];
  const CoarseGarment coarse = coarse_garment(fine, 2);
  const auto& out = coarse.garment;
  EXPECT_LT(out.mesh.positions.size(), fine.mesh.positions.size() / 3);
  ASSERT_EQ(out.maps.bend.size(), out.mesh.positions.size());
  for (std::size_t i = 0; i < out.mesh.positions.size(); ++i)
    EXPECT_EQ(out.maps.bend[i], 1 + out.mesh.positions[i].z());
  ASSERT_EQ(out.pins.size(), 1u);
  EXPECT_GE(out.pins[0].vertices.size(), 14u);
  EXPECT_EQ(out.pins[0].vertices.size(), out.pins[0].weights.size());
  for (const int v : out.pins[0].vertices) EXPECT_LT(out.mesh.positions[at(v)].x(), -0.2999);
}

TEST(CoarseSolver, The_given_vertices_start_where_they_are_and_end_near_where_they_would) {
  const ClothSetup fine = swinging_sheet(1), coarse = swinging_sheet(2);
  const std::vector<Vec3> start = after(coarse, 0);
  for (std::size_t i = 0; i < start.size(); ++i)
    EXPECT_LT((start[i] - fine.garments[0].mesh.positions[i]).norm(), 1e-12);
  const std::vector<Vec3> a = after(fine, 30), b = after(coarse, 30);
  double sum = 0, fall = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - b[i]).norm() / static_cast<double>(a.size());
    fall += (a[i] - start[i]).norm() / static_cast<double>(a.size());
  }
  EXPECT_GT(fall, 0.2);
  EXPECT_LT(sum, 0.1 * fall);
}

TEST(CoarseSolver, Does_not_depend_on_the_number_of_threads) {
  const ClothSetup setup = swinging_sheet(2);
  std::vector<std::vector<Vec3>> x;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    x.push_back(after(setup, 6));
  }
  EXPECT_EQ(x[0], x[1]);
}

TEST(CoarseSolver, What_is_wrong_is_said_of_the_given_garment) {
  ClothSetup setup = swinging_sheet(2);
  setup.garments[0].maps.bend[1234] = -1;
  const auto refused = make_cloth_solver(setup);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("vertex 1234"), std::string::npos) << refused.error().text();
}

TEST(CoarseSolver, Garments_that_are_sewn_or_cut_from_a_pattern_stay_as_they_are) {
  ClothGarment garment = swinging_sheet(1).garments[0];
  garment.mesh.stitches.push_back({0, {40, 40}, 0, 0});
  const CoarseGarment same = coarse_garment(garment, 2);
  EXPECT_EQ(same.garment.mesh.positions, garment.mesh.positions);
  EXPECT_EQ(same.kept.size(), garment.mesh.positions.size());
  EXPECT_EQ(same.places[77].vertex[0], 77);
}

}  // namespace
}  // namespace ft

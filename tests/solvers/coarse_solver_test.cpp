// Previews: a coarser garment moves, and the given one is answered for.
#include <gtest/gtest.h>

#include "baker/core/parallel.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/cloth/embed/coarse_garment.h"
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

/// Two panels of a pattern, side by side and edge to edge, sewn along the gap between them.
ClothGarment two_panels() {
  ClothGarment out;
  out.name = "panels";
  const Mesh left = make_sheet(0.4, 20, 0);
  const int n = left.vertex_count();
  std::vector<Vec3> x = left.positions;
  std::vector<Triangle> triangles = triangulate(left);
  for (int v = 0; v < n; ++v) x.push_back(left.positions[at(v)] + Vec3(0.45, 0, 0));
  for (std::size_t t = 0, count = triangles.size(); t < count; ++t)
    triangles.push_back({triangles[t][0] + n, triangles[t][1] + n, triangles[t][2] + n});
  out.mesh = make_triangle_mesh("panels", x, triangles);
  for (const Vec3& p : x) out.mesh.uvs.emplace_back(2 * p.x(), 2 * p.z());
  out.mesh.face_uvs = out.mesh.face_vertices;
  out.pattern_scale = 0.5;
  for (int v = 0; v < n; ++v)
    for (int w = n; w < 2 * n; ++w)
      if ((x[at(v)] - x[at(w)]).norm() < 0.051) out.mesh.stitches.push_back({w, {v, v}, 0, 0});
  return out;
}

TEST(CoarseSolver, A_seam_keeps_its_stitches_and_the_pattern_its_shape) {
  const ClothGarment fine = two_panels();
  ASSERT_EQ(fine.mesh.stitches.size(), 21u);
  const CoarseGarment coarse = coarse_garment(fine, 2);
  const Mesh& mesh = coarse.garment.mesh;
  EXPECT_LT(mesh.positions.size(), fine.mesh.positions.size() / 2);
  ASSERT_EQ(mesh.stitches.size(), fine.mesh.stitches.size());
  for (std::size_t s = 0; s < mesh.stitches.size(); ++s) {
    EXPECT_EQ(coarse.kept[at(mesh.stitches[s].vertex)], fine.mesh.stitches[s].vertex);
    EXPECT_EQ(coarse.kept[at(mesh.stitches[s].edge[0])], fine.mesh.stitches[s].edge[0]);
  }
  EXPECT_EQ(coarse.garment.pattern_scale, 0.5);
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
    const Vec3& p = mesh.positions[at(mesh.face_vertices[c])];
    EXPECT_LT((mesh.uvs[at(mesh.face_uvs[c])] - Vec2(2 * p.x(), 2 * p.z())).norm(), 1e-12);
  }
}

TEST(CoarseSolver, Panels_are_sewn_together_in_a_preview) {
  ClothSetup setup;
  setup.preroll_frames = 24;
  setup.coarsen = 2;
  setup.garments.push_back(two_panels());
  const std::vector<Vec3> x = after(setup, 24);
  for (const Stitch& s : setup.garments[0].mesh.stitches) EXPECT_LT((x[at(s.vertex)] - x[at(s.edge[0])]).norm(), 1e-3);
}

}  // namespace
}  // namespace ft

// Stitches of garment files: read, written, refused.
#include <gtest/gtest.h>

#include "io/shot/mesh_file.h"
#include "io/shot/weld.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

/// Two squares of two triangles, side by side 0.1 apart, each with its own vertices and pattern.
const std::string k_panels =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1.1 0 0\nv 2.1 0 0\nv 2.1 1 0\nv 1.1 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 3 0\nvt 3 1\nvt 2 1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/5 6/6 7/7\nf 5/5 7/7 8/8\n";

std::string fault_of(const std::string& lines) {
  const auto mesh = parse_obj(k_panels + lines, "x.obj");
  if (!mesh) return mesh.error().text();
  const Status good = check_garment(*mesh);
  return good ? "accepted" : good.error().text();
}

TEST(SewingMesh, Stitches_count_from_0_and_seams_number_them) {
  const auto mesh =
      parse_obj(k_panels + "seam 2\nstitch 1 4 7 0.25\nstitch 2 7 4 1.0e+000\nseam 1\nstitch 0 5 # a pair\n", "x.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  const std::vector<Stitch> expected{{1, {4, 7}, 0.25, 0}, {2, {7, 4}, 1, 0}, {0, {5, 5}, 0, 1}};
  EXPECT_EQ(mesh->stitches, expected);
  EXPECT_EQ(panel_count(*mesh), 2);
  EXPECT_TRUE(inspect_garment(*mesh).notes.empty());  // sewn, it is one piece
}

TEST(SewingMesh, What_is_written_is_read_back) {
  auto mesh = parse_obj(k_panels + "stitch 1 4 7 0.1\nseam 1\nseam 7\nstitch 2 7 4 0.9999999999999999\n", "x.obj");
  ASSERT_TRUE(mesh.ok());
  const auto path = std::filesystem::path(testing::TempDir()) / "sewn.obj";
  ASSERT_TRUE(write_obj(path, *mesh).ok());
  const auto again = read_obj(path);
  ASSERT_TRUE(again.ok()) << again.error().text();
  EXPECT_EQ(again->stitches, mesh->stitches);
}

TEST(SewingMesh, Broken_stitches_are_named_with_their_line) {
  const auto expect = [](const std::string& lines, const std::string& part) {
    EXPECT_NE(fault_of(lines).find(part), std::string::npos) << fault_of(lines);
  };
  expect("stitch 0 8\n", "x.obj:21: stitch names vertex 8, the file has 0 to 7");
  expect("stitch -1 4\n", "x.obj:21: stitch names vertex -1, which does not exist; they count from 0");
  expect("stitch 99999999999999999999 4\n", "for a vertex");
  expect("stitch 3000000000 4\n", "which does not exist");
  expect("stitch 1 4 7 nan\n", "\"nan\" for a place, which is from 0 to 1");
  expect("stitch 1 4 7 1.5\n", "\"1.5\" for a place");
  expect("stitch 1 4 7 -0.1\n", "\"-0.1\" for a place");
  expect("stitch 1 4 7\n", "stitch needs two vertices");
  expect("stitch 1\n", "stitch needs two vertices");
  expect("stitch\n", "stitch needs two vertices");
  expect("stitch 1 4 7 0 0\n", "stitch needs two vertices");
  expect("stitch a 4\n", "stitch has \"a\" for a vertex");
}

TEST(SewingMesh, Stitches_that_sew_nothing_are_refused_in_one_message) {
  EXPECT_NE(fault_of("stitch 1 1\nstitch 1 4 1 0.5\n").find("2 stitches sew (0, 1) a vertex to itself"),
            std::string::npos);
  EXPECT_NE(fault_of("v 9 9 9\nstitch 1 8\n").find("1 stitch sews (0) a vertex that no face uses"), std::string::npos);
  std::string many;
  for (int i = 0; i < 5000; ++i) many += "stitch 1 4 7 " + std::to_string(i / 5000.0) + "\n";
  const std::string fault = fault_of(many);
  EXPECT_NE(fault.find("1 vertex is (1) sewn to more than 16 places"), std::string::npos) << fault;
  EXPECT_LT(fault.size(), 300u);
}

TEST(SewingMesh, Duplicates_count_once_and_are_a_note) {
  std::string many;
  for (int i = 0; i < 5000; ++i) many += "stitch 1 4 7 0.5\n";
  const auto mesh = parse_obj(k_panels + many, "x.obj");
  ASSERT_TRUE(mesh.ok());
  const auto findings = inspect_garment(*mesh);
  EXPECT_TRUE(findings.faults.empty());
  ASSERT_EQ(findings.notes.size(), 1u);
  EXPECT_EQ(findings.notes[0], "4999 stitches are there twice; each counts once");
}

TEST(SewingMesh, A_pattern_needs_an_area_for_every_face) {
  auto mesh = parse_obj(k_panels, "x.obj");
  ASSERT_TRUE(mesh.ok());
  std::vector<std::string> notes;
  EXPECT_TRUE(check_pattern(*mesh, 1, notes).ok());
  EXPECT_TRUE(notes.empty());
  EXPECT_TRUE(check_pattern(*mesh, 100, notes).ok());
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("is pattern_scale right?"), std::string::npos);
  mesh->uvs[2] = 0.5 * (mesh->uvs[0] + mesh->uvs[1]);
  const Status flat = check_pattern(*mesh, 1, notes);
  ASSERT_FALSE(flat.ok());
  EXPECT_NE(flat.error().text().find("1 face has (0) no area in vt"), std::string::npos) << flat.error().text();
  mesh->uvs.clear();
  mesh->face_uvs.clear();
  EXPECT_FALSE(check_pattern(*mesh, 1, notes).ok());
}

TEST(SewingMesh, Welding_takes_stitches_along_and_drops_what_it_closes) {
  auto mesh = parse_obj(k_panels + "stitch 1 4\nstitch 2 7\nstitch 0 6 5 0.5\n", "x.obj");
  ASSERT_TRUE(mesh.ok());
  mesh->positions[4] = mesh->positions[1] + Vec3(1e-4, 0, 0);
  const WeldedMesh welded = weld(*mesh, 1e-3);
  const std::vector<Stitch> expected{{2, {6, 6}, 0, 0}, {0, {5, 4}, 0.5, 0}};
  EXPECT_EQ(welded.mesh.stitches, expected);
}

TEST(SewingMesh, The_knife_dress_has_14_panels_and_94_seams) {
  FT_REQUIRE_FILE(test::assets_root() / "garments/cipc_dress_knife/stage.obj");
  const auto mesh = read_obj(test::assets_root() / "garments/cipc_dress_knife/stage.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_EQ(panel_count(*mesh), 14);
  EXPECT_EQ(mesh->stitches.size(), 851u);
  EXPECT_EQ(mesh->stitches.back().seam, 93);
  EXPECT_TRUE(check_garment(*mesh).ok());
  std::vector<std::string> notes;
  EXPECT_TRUE(check_pattern(*mesh, 1, notes).ok());
  EXPECT_TRUE(notes.empty());
}

}  // namespace
}  // namespace ft

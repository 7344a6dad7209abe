#include <gtest/gtest.h>

#include <cmath>

#include "io/shot/mesh_file.h"
#include "io/shot/weld.h"

namespace ft {
namespace {

Mesh grid(int columns, int rows) {
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.positions.emplace_back(0.1 * i, -0.1 * j, 0);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, below = a + columns + 1;
      mesh.face_sizes.push_back(4);
      for (const int v : {a, below, below + 1, a + 1}) mesh.face_vertices.push_back(v);
    }
  return mesh;
}

void add_face(Mesh& mesh, std::initializer_list<int> corners) {
  mesh.face_sizes.push_back(static_cast<int>(corners.size()));
  mesh.face_vertices.insert(mesh.face_vertices.end(), corners);
}

bool has(const std::vector<std::string>& lines, std::string_view part) {
  for (const std::string& line : lines)
    if (line.find(part) != std::string::npos) return true;
  return false;
}

TEST(Garment, Plain_sheet_passes_without_a_note) {
  const auto findings = inspect_garment(grid(4, 3));
  EXPECT_TRUE(findings.faults.empty());
  EXPECT_TRUE(findings.notes.empty());
  EXPECT_TRUE(check_garment(grid(4, 3)).ok());
}

TEST(Garment, Empty_meshes_are_refused) {
  EXPECT_TRUE(has(inspect_garment(Mesh{}).faults, "has no vertices"));
  Mesh points;
  points.positions.assign(3, Vec3::Zero());
  EXPECT_TRUE(has(inspect_garment(points).faults, "has no faces"));
}

TEST(Garment, Indices_that_do_not_fit_are_refused) {
  Mesh mesh = grid(2, 2);
  mesh.face_vertices.back() = 9;
  EXPECT_FALSE(check_garment(mesh).ok());
  mesh.face_vertices.back() = -1;
  EXPECT_FALSE(check_garment(mesh).ok());
  mesh = grid(2, 2);
  mesh.face_sizes.back() = 5;
  EXPECT_FALSE(check_garment(mesh).ok());
}

TEST(Garment, Numbers_that_are_not_finite_are_refused) {
  Mesh mesh = grid(2, 2);
  mesh.positions[3].y() = std::nan("");
  mesh.positions[5].z() = INFINITY;
  EXPECT_TRUE(has(inspect_garment(mesh).faults, "2 vertices are (3, 5) not a finite point"));
}

TEST(Garment, Edge_with_three_faces_is_refused) {
  Mesh mesh = grid(2, 2);
  mesh.positions.emplace_back(0.1, 0, 0.1);
  add_face(mesh, {1, 4, 9});
  EXPECT_TRUE(has(inspect_garment(mesh).faults, "1 edge has (1-4) more than two faces"));
}

TEST(Garment, Face_that_uses_a_vertex_twice_is_refused) {
  Mesh mesh = grid(2, 2);
  mesh.positions.emplace_back(0.5, 0, 0.1);
  add_face(mesh, {2, 9, 2});
  EXPECT_TRUE(has(inspect_garment(mesh).faults, "1 face uses (4) a vertex twice"));
}

TEST(Garment, Face_without_area_is_refused_and_a_sliver_is_not) {
  Mesh mesh = grid(2, 2);
  mesh.positions.insert(mesh.positions.end(), {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)});
  add_face(mesh, {9, 10, 11});
  EXPECT_TRUE(has(inspect_garment(mesh).faults, "1 face has (4) no area"));
  mesh.positions[10].y() = 1e-12;
  EXPECT_TRUE(has(inspect_garment(mesh).faults, "no area"));
  mesh.positions[10].y() = 1e-4;
  EXPECT_TRUE(inspect_garment(mesh).faults.empty());
}

// Split along 0-2, the shorter diagonal, the first half of this quad is the line 0, 1, 2.
TEST(Garment, Quad_with_a_corner_in_line_is_refused_when_it_splits_there) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(1, 3, 0)};
  add_face(mesh, {0, 1, 2, 3});
  EXPECT_TRUE(has(inspect_garment(mesh).faults, "1 face has (0) no area, or a corner in line with its neighbours"));
  mesh.positions[3].y() = 1.5;
  EXPECT_TRUE(check_garment(mesh).ok());  // now 1-3 is the shorter one, and both halves have area
}

TEST(Garment, Coincident_vertices_are_refused_and_counted_once) {
  Mesh mesh = grid(3, 1);
  for (const int twin : {0, 0, 5}) mesh.positions.push_back(mesh.positions[static_cast<std::size_t>(twin)]);
  mesh.positions.emplace_back(0.05, 0.2, 0);
  add_face(mesh, {8, 9, 11});
  add_face(mesh, {10, 11, 9});
  const auto findings = inspect_garment(mesh);
  EXPECT_TRUE(has(findings.faults, "3 vertices lie (8 on 0, 9 on 0, 10 on 5) exactly on another"));
}

TEST(Garment, Coincidence_is_found_as_by_brute_force) {
  Mesh mesh = grid(9, 9);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    // A crumpled sheet: many vertices of nearly equal x, some in exactly one place.
    mesh.positions[i] = Vec3(0.001 * static_cast<double>(i % 3), 0.01 * static_cast<double>((i * 37) % 89),
                             0.01 * static_cast<double>((i * 53) % 7));
  }
  std::size_t twins = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (mesh.positions[i] == mesh.positions[j]) {
        ++twins;
        break;
      }
  const auto findings = inspect_garment(mesh);
  if (twins == 0)
    EXPECT_FALSE(has(findings.faults, "exactly on another"));
  else
    EXPECT_TRUE(has(findings.faults, std::to_string(twins) + (twins == 1 ? " vertex lies" : " vertices lie")));
}

TEST(Garment, Isolated_vertices_are_a_note_even_when_they_coincide) {
  Mesh mesh = grid(2, 2);
  mesh.positions.insert(mesh.positions.end(), 2, Vec3::Zero());
  const auto findings = inspect_garment(mesh);
  EXPECT_TRUE(findings.faults.empty());
  EXPECT_TRUE(has(findings.notes, "2 vertices belong (9, 10) to no face"));
}

TEST(Garment, Mixed_winding_and_pieces_are_notes) {
  Mesh mesh = grid(2, 1);
  std::swap(mesh.face_vertices[5], mesh.face_vertices[7]);
  EXPECT_TRUE(has(inspect_garment(mesh).notes, "1 edge lies (1-4) between faces of opposite winding"));
  mesh = grid(2, 1);
  mesh.positions.insert(mesh.positions.end(), {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0)});
  add_face(mesh, {6, 7, 8});
  EXPECT_TRUE(has(inspect_garment(mesh).notes, "falls into 2 pieces"));
}

TEST(Garment, All_faults_come_in_one_message_that_names_the_mesh) {
  Mesh mesh = grid(2, 2);
  mesh.name = "cape";
  mesh.positions.insert(mesh.positions.end(), {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0), mesh.positions[0]});
  add_face(mesh, {9, 10, 11});
  add_face(mesh, {12, 9, 9});
  const Status status = check_garment(mesh);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().where, "mesh \"cape\"");
  for (const char* part : {"no area", "a vertex twice", "exactly on another"})
    EXPECT_NE(status.error().what.find(part), std::string::npos) << part;
}

/// A tube cut open: the seam's vertices exist twice.
Mesh open_tube(int around, int rows) {
  Mesh mesh = grid(around, rows);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double angle = 2 * M_PI * static_cast<double>(static_cast<int>(i) % (around + 1) % around) / around;
    mesh.positions[i] = Vec3(std::cos(angle), mesh.positions[i].y(), std::sin(angle));
  }
  return mesh;
}

TEST(Weld, Open_seam_closes_and_then_passes) {
  const Mesh tube = open_tube(12, 4);
  EXPECT_FALSE(check_garment(tube).ok());
  const WeldedMesh welded = weld(tube, 1e-6);
  EXPECT_TRUE(check_garment(welded.mesh).ok());
  EXPECT_EQ(welded.mesh.vertex_count(), tube.vertex_count() - 5);
  EXPECT_EQ(welded.mesh.face_count(), tube.face_count());
  std::vector<Vec3> back(tube.positions.size());
  spread_welded(welded.joined_of, welded.mesh.positions, back);
  EXPECT_EQ(back, tube.positions);
}

TEST(Weld, What_is_wrong_with_a_joined_mesh_is_told_in_numbers_of_the_file) {
  Mesh mesh = grid(2, 2);
  mesh.positions.insert(mesh.positions.begin(), 2, mesh.positions[0]);  // two that join the third, and no face has
  for (int& v : mesh.face_vertices) v += 2;
  mesh.positions.insert(mesh.positions.end(), {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)});
  mesh.face_sizes.insert(mesh.face_sizes.begin(), 3);
  mesh.face_vertices.insert(mesh.face_vertices.begin(), {0, 1, 4});  // loses its area
  add_face(mesh, {11, 12, 13});
  mesh.positions.push_back(mesh.positions[12] + Vec3(0, 1, 0));  // in no face
  mesh.stitches = {{0, {2, 3}, 0.5, 0}, {5, {14, 14}, 0, 0}};    // the first closes
  const WeldedMesh welded = weld(mesh, 1e-6);
  EXPECT_EQ(welded.in_file.vertices, (std::vector<int>{0, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}));
  EXPECT_EQ(welded.in_file.faces, (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_EQ(welded.in_file.stitches, (std::vector<int>{1}));
  const auto findings = inspect_garment(welded.mesh, welded.in_file);
  EXPECT_TRUE(has(findings.faults, "1 face has (5) no area"));
  EXPECT_TRUE(has(findings.faults, "1 stitch sews (1) a vertex that no face uses"));
  EXPECT_TRUE(has(findings.notes, "1 vertex belongs (14) to no face"));
}

TEST(Weld, Triangles_of_the_joined_mesh_are_given_to_the_vertices_of_the_file) {
  Mesh mesh = open_tube(5, 2);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.uvs.emplace_back(0.1 * static_cast<double>(i), 0);
  mesh.face_uvs = mesh.face_vertices;
  const WeldedMesh welded = weld(mesh, 1e-6);
  const Mesh split = with_triangles_of(mesh, welded.mesh, welded.in_file);
  EXPECT_EQ(split.positions, mesh.positions);
  EXPECT_EQ(split.face_uvs, split.face_vertices);
  std::vector<Triangle> joined = triangulate(split);
  for (Triangle& t : joined)
    for (int& v : t) v = welded.joined_of[static_cast<std::size_t>(v)];
  EXPECT_EQ(joined, triangulate(welded.mesh));
  EXPECT_EQ(triangulate(with_triangles_of(mesh, mesh, {})), triangulate(mesh));
}

TEST(Weld, Mesh_without_near_vertices_stays_as_it_is) {
  const Mesh mesh = grid(5, 4);
  const WeldedMesh welded = weld(mesh, 0.01);
  EXPECT_EQ(welded.mesh.positions, mesh.positions);
  EXPECT_EQ(welded.mesh.face_vertices, mesh.face_vertices);
  EXPECT_EQ(welded.mesh.face_sizes, mesh.face_sizes);
}

TEST(Weld, Kept_vertices_are_apart_and_joined_ones_near_for_any_distance) {
  Mesh mesh = open_tube(30, 10);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.positions[i].x() += 1e-3 * static_cast<double>(i % 5);
  mesh.groups.push_back({"hem", {0, 30, 31}, {0.5, 1, 0.25}});
  for (const double distance : {1e-6, 1e-3, 5e-3, 0.02}) {
    const WeldedMesh welded = weld(mesh, distance);
    for (std::size_t i = 0; i < welded.mesh.positions.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GE((welded.mesh.positions[i] - welded.mesh.positions[j]).norm(), distance);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      ASSERT_LT((mesh.positions[i] - welded.mesh.positions[static_cast<std::size_t>(welded.joined_of[i])]).norm(),
                distance);
    for (const int size : welded.mesh.face_sizes) ASSERT_GE(size, 3);
  }
}

TEST(Weld, Groups_and_uvs_follow) {
  Mesh mesh = open_tube(4, 1);
  for (int i = 0; i < 10; ++i) mesh.uvs.emplace_back(0.1 * i, 0);
  mesh.face_uvs = mesh.face_vertices;
  mesh.groups.push_back({"seam", {0, 4, 9}, {0.25, 1, 0.5}});
  const WeldedMesh welded = weld(mesh, 1e-6);
  ASSERT_EQ(welded.mesh.groups.size(), 1u);
  EXPECT_EQ(welded.mesh.groups[0].vertices, (std::vector<int>{0, 4}));  // 5 of the file is 4 here, 9 joins it
  EXPECT_EQ(welded.mesh.groups[0].weights, (std::vector<double>{1, 0.5}));
  EXPECT_EQ(welded.mesh.face_uvs, mesh.face_uvs);
}

}  // namespace
}  // namespace ft

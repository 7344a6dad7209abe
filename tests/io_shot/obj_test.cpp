#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "baker/core/file.h"
#include "baker/core/random.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"
#include "tests/support/damage.h"

namespace ft {
namespace {

using namespace std::string_view_literals;

const char* const k_good =
    "# a strip\n"
    "o strip\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0.5\nv 2 1 0.5\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 2 1\n"
    "vn 0 0 1\n"
    "seam 1 2\nstitch 3 4\nusemtl blue\ns off\n"
    "g left hem\n"
    "f 1/1/1 2/2/1 3/3/1 4/4/1\n"
    "g right\n"
    "f 2/2/1 5/5/1 6/6/1\n"
    "f -5/-5 -1/-1 -4/-4\n";

/// What every accepted mesh keeps: sizes fit, indices exist, numbers are finite.
void expect_sound(const Mesh& mesh) {
  std::size_t corners = 0;
  for (const int size : mesh.face_sizes) {
    ASSERT_GE(size, 3);
    corners += static_cast<std::size_t>(size);
  }
  ASSERT_EQ(corners, mesh.face_vertices.size());
  for (const int v : mesh.face_vertices) ASSERT_TRUE(v >= 0 && v < mesh.vertex_count());
  ASSERT_TRUE(mesh.face_uvs.empty() || mesh.face_uvs.size() == corners);
  ASSERT_EQ(mesh.face_uvs.empty(), mesh.uvs.empty());
  for (const int uv : mesh.face_uvs) ASSERT_TRUE(uv >= 0 && uv < static_cast<int>(mesh.uvs.size()));
  ASSERT_TRUE(all_finite(mesh.positions));
  for (const VertexGroup& group : mesh.groups) {
    ASSERT_EQ(group.vertices.size(), group.weights.size());
    for (const int v : group.vertices) ASSERT_TRUE(v >= 0 && v < mesh.vertex_count());
  }
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.face_sizes, b.face_sizes);
  EXPECT_EQ(a.face_vertices, b.face_vertices);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.face_uvs, b.face_uvs);
  ASSERT_EQ(a.groups.size(), b.groups.size());
  for (std::size_t i = 0; i < a.groups.size(); ++i) {
    EXPECT_EQ(a.groups[i].name, b.groups[i].name);
    EXPECT_EQ(a.groups[i].vertices, b.groups[i].vertices);
    EXPECT_EQ(a.groups[i].weights, b.groups[i].weights);
  }
}

std::string fault_of(std::string_view text) {
  const auto mesh = parse_obj(text, "x.obj");
  return mesh ? "accepted" : mesh.error().text();
}

TEST(Obj, Order_of_the_file_is_kept) {
  const auto mesh = parse_obj(k_good, "strip.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  ASSERT_EQ(mesh->vertex_count(), 6);
  EXPECT_EQ(mesh->positions[4], Vec3(2, 0, 0.5));
  EXPECT_EQ(mesh->face_sizes, (std::vector<int>{4, 3, 3}));
  EXPECT_EQ(mesh->face_vertices, (std::vector<int>{0, 1, 2, 3, 1, 4, 5, 1, 5, 2}));
  EXPECT_EQ(mesh->face_uvs, (std::vector<int>{0, 1, 2, 3, 1, 4, 5, 1, 5, 2}));
  EXPECT_EQ(mesh->uvs[4], Vec2(2, 0));
}

TEST(Obj, Face_groups_and_objects_become_vertex_groups) {
  const auto mesh = parse_obj(k_good, "strip.obj");
  ASSERT_TRUE(mesh.ok());
  ASSERT_EQ(mesh->groups.size(), 4u);
  EXPECT_EQ(mesh->groups[0].name, "strip");
  EXPECT_EQ(mesh->groups[0].vertices, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(mesh->groups[1].name, "left");
  EXPECT_EQ(mesh->groups[1].vertices, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(mesh->groups[2].name, "hem");
  EXPECT_EQ(mesh->groups[3].name, "right");
  EXPECT_EQ(mesh->groups[3].vertices, (std::vector<int>{1, 2, 4, 5}));
}

TEST(Obj, Vertex_colours_become_weighted_groups) {
  const auto mesh = parse_obj("v 0 0 0 1 0 0.25\nv 1 0 0\nv 0 1 0 0.5 2 0\nf 1 2 3\n", "x.obj");
  ASSERT_TRUE(mesh.ok());
  ASSERT_EQ(mesh->groups.size(), 3u);
  EXPECT_EQ(mesh->groups[0].name, "red");
  EXPECT_EQ(mesh->groups[0].vertices, (std::vector<int>{0, 2}));
  EXPECT_EQ(mesh->groups[0].weights, (std::vector<double>{1, 0.5}));
  EXPECT_EQ(mesh->groups[1].weights, (std::vector<double>{1}));
  EXPECT_EQ(mesh->groups[2].vertices, (std::vector<int>{0}));
}

TEST(Obj, Colours_from_0_to_255_are_read_as_such_and_that_is_said) {
  std::vector<std::string> notes;
  const auto mesh = parse_obj("v 0 0 0 255 0 51\nv 1 0 0 0 1 0\nv 0 1 0 127.5 0 0\nf 1 2 3\n", "x.obj", &notes);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_EQ(notes, (std::vector<std::string>{"vertex colours go up to 255: they are read as 0 to 255"}));
  ASSERT_EQ(mesh->groups.size(), 3u);
  EXPECT_EQ(mesh->groups[0].weights, (std::vector<double>{1, 0.5}));
  EXPECT_EQ(mesh->groups[1].weights, (std::vector<double>{1 / 255.0}));
  EXPECT_EQ(mesh->groups[2].weights, (std::vector<double>{0.2}));
  // Dark ones are whole numbers above 1; a 1 that was rounded and light above 1 are not of 0 to 255.
  ASSERT_TRUE(parse_obj("v 0 0 0 2 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n", "x.obj", &notes).ok());
  EXPECT_EQ(notes.at(0), "vertex colours go up to 2: they are read as 0 to 255");
  ASSERT_TRUE(parse_obj("v 0 0 0 1.001 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "x.obj", &notes).ok());
  EXPECT_TRUE(notes.empty());
  ASSERT_TRUE(parse_obj("v 0 0 0 1.5 0 0\nv 1 0 0 0.3 0 0\nv 0 1 0\nf 1 2 3\n", "x.obj", &notes).ok());
  EXPECT_EQ(notes.at(0), "vertex colours go up to 1.5: what is above 1 counts as 1");
  EXPECT_EQ(fault_of("v 0 0 0\nv 1 0 0 0 65535 0\nv 0 1 0\nf 1 2 3\n").substr(0, 75),
            "x.obj:2: vertex has a colour of 65535; colours are from 0 to 1, or from 0 t");
}

TEST(Obj, Line_ends_blanks_comments_and_continuations_do_not_matter) {
  const auto plain = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "x");
  for (const char* text :
       {"\xef\xbb\xbfv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "  v\t0  0 0 # one\nv +1 0 0\n\n\nv 0 1 0 \nf 1 2 3 # two", "v 0 \\\n 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n2 \\\n3",
        "f 1 2 3\nv 0 0 0\nv 1e0 0 0\nv 0 1.0 -0\n", "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1//9 2//9 3//9"}) {
    const auto mesh = parse_obj(text, "x");
    ASSERT_TRUE(mesh.ok()) << mesh.error().text();
    EXPECT_EQ(mesh->positions, plain->positions) << text;
    EXPECT_EQ(mesh->face_vertices, plain->face_vertices) << text;
  }
}

TEST(Obj, Line_numbers_count_continued_lines) {
  EXPECT_EQ(fault_of("v 0 \\\n 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").substr(0, 8), "x.obj:5:");
}

TEST(Obj, Uvs_are_kept_only_when_every_corner_has_one) {
  const auto mesh = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf 2 4 3\n", "x");
  ASSERT_TRUE(mesh.ok());
  EXPECT_TRUE(mesh->uvs.empty());
  EXPECT_TRUE(mesh->face_uvs.empty());
}

TEST(Obj, Faults_name_line_and_cause) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(fault_of(three + "f 1 2 4\n").substr(0, 68),
            "x.obj:4: face names vertex 4 as OBJ counts, from 1; the file has 3 (");
  EXPECT_NE(fault_of("v 0 nan 0\n").find("x.obj:1: vertex has the value nan, which is not finite"), std::string::npos);
  EXPECT_NE(fault_of("v 0 1e999 0\n").find("not finite"), std::string::npos);
  EXPECT_NE(fault_of("v 0 -inf 0\n").find("not finite"), std::string::npos);
  EXPECT_NE(fault_of("v 0 0\n").find("2 coordinates, three are needed"), std::string::npos);
  EXPECT_NE(fault_of("v 0,5 0 0\n").find("decimal comma"), std::string::npos);
  EXPECT_NE(fault_of(three + "f 1 2\n").find("face has 2 corners"), std::string::npos);
  EXPECT_NE(fault_of(three + "f 0 1 2\n").find("vertex 0; they count from 1"), std::string::npos);
  EXPECT_NE(fault_of(three + "f 1 2 -4\n").find("vertex -4, which does not exist"), std::string::npos);
  EXPECT_NE(fault_of(three + "f 1 2 99999999999\n").find("does not exist"), std::string::npos);
  EXPECT_NE(fault_of(three + "f 1 2 99999999999999999999999\n").find("for a vertex"), std::string::npos);
  EXPECT_NE(fault_of(three + "f 1/1 2/1 3/1\n").find("texture vertex 1 as OBJ counts, from 1; the file has 0"),
            std::string::npos);
  EXPECT_NE(fault_of(three + "f 1 2 x\n").find("face has \"x\" for a vertex"), std::string::npos);
  EXPECT_NE(fault_of("").find("holds no vertices"), std::string::npos);
  EXPECT_NE(fault_of("PK\x03\x04 binary").find("holds no vertices"), std::string::npos);
  EXPECT_EQ(fault_of("v 1e-400 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "accepted");
}

TEST(Obj, All_faults_are_counted_and_the_first_are_shown) {
  std::string text;
  for (int i = 0; i < 30; ++i) text += "v 0 0 x\n";
  const std::string fault = fault_of(text);
  EXPECT_NE(fault.find("x.obj:5:"), std::string::npos);
  EXPECT_EQ(fault.find("x.obj:6:"), std::string::npos);
  EXPECT_NE(fault.find("and 25 more"), std::string::npos);
}

TEST(Obj, Cut_at_any_byte_is_a_sound_mesh_or_a_fault) {
  const std::string text = k_good;
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const auto mesh = parse_obj(std::string_view(text).substr(0, n), "cut.obj");
    if (mesh)
      expect_sound(*mesh);
    else
      EXPECT_FALSE(mesh.error().what.empty());
  }
}

TEST(Obj, Ten_thousand_mutations_are_sound_meshes_or_faults) {
  const std::string good = k_good;
  const test::TextDamage damage{"0123456789.-+eE/\\ \nvfgtn#x\r\t\x00\xff"sv, 6, 20};
  int accepted = 0;
  for (std::uint64_t round = 0; round < 10'000; ++round) {
    const auto mesh = parse_obj(test::damaged(good, damage, round), "mutated.obj");
    if (mesh) expect_sound(*mesh), ++accepted;
  }
  // Both outcomes occur, or the mutations would test nothing.
  EXPECT_GT(accepted, 500);
  EXPECT_LT(accepted, 9'500);
}

TEST(Obj, Written_mesh_reads_back_to_the_same_bits) {
  test::ScratchFolder folder;
  Mesh mesh;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const RandomKey key{.seed = 3, .element = i};
    mesh.positions.emplace_back(random_uniform(key, 0) - 0.5, 1e-9 * random_uniform(key, 1),
                                1e6 * random_uniform(key, 2));
    mesh.uvs.emplace_back(random_uniform(key, 3), random_uniform(key, 4));
  }
  for (int f = 0; f < 50; ++f) {
    const int size = 3 + f % 3;
    mesh.face_sizes.push_back(size);
    for (int k = 0; k < size; ++k) mesh.face_vertices.push_back(f + k), mesh.face_uvs.push_back((f * 7 + k) % 60);
  }
  mesh.groups.push_back({"hem", {0, 1, 2, 3, 4, 5, 6}, std::vector<double>(7, 1.0)});
  mesh.groups.push_back({"red", {2, 9}, {0.25, 1}});
  ASSERT_TRUE(write_obj(folder / "a.obj", mesh).ok());
  const auto back = read_obj(folder / "a.obj");
  ASSERT_TRUE(back.ok()) << back.error().text();
  EXPECT_EQ(back->name, "a");
  expect_same(*back, mesh);
}

TEST(Obj, Mesh_that_is_not_finite_is_not_written) {
  test::ScratchFolder folder;
  Mesh mesh;
  mesh.positions.emplace_back(0, std::nan(""), 0);
  EXPECT_FALSE(write_obj(folder / "a.obj", mesh).ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "a.obj"));
}

TEST(Obj, Missing_file_and_folder_are_named) {
  const auto missing = read_obj("/nowhere/dress.obj");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().where, "/nowhere/dress.obj");
  EXPECT_FALSE(read_obj(std::filesystem::temp_directory_path()).ok());
}

/// Slow and plain: one line after the other with the standard library, positions and corners only.
Mesh plain_reader(const std::filesystem::path& path) {
  Mesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key, word;
    words >> key;
    if (key == "v") {
      Vec3 p;
      for (int k = 0; k < 3; ++k) words >> word, p[k] = std::strtod(word.c_str(), nullptr);
      mesh.positions.push_back(p);
    } else if (key == "f") {
      int size = 0;
      while (words >> word) mesh.face_vertices.push_back(std::atoi(word.c_str()) - 1), ++size;
      mesh.face_sizes.push_back(size);
    }
  }
  return mesh;
}

class RealGarment : public testing::TestWithParam<const char*> {};

TEST_P(RealGarment, Reads_as_the_plain_reader_does_and_passes_or_names_its_fault) {
  const auto path = test::assets_root() / GetParam();
  FT_REQUIRE_FILE(path);
  const auto mesh = read_obj(path);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  expect_sound(*mesh);
  const Mesh plain = plain_reader(path);
  EXPECT_EQ(mesh->positions, plain.positions);
  EXPECT_EQ(mesh->face_sizes, plain.face_sizes);
  EXPECT_EQ(mesh->face_vertices, plain.face_vertices);
  const Status status = check_garment(*mesh);
  // The end of a simulation with its seams closed by coincident vertices: 98 of them lie on others.
  if (path.filename() == "drape.obj")
    EXPECT_TRUE(!status.ok() && status.error().what.find("98 vertices lie") != std::string::npos);
  else
    EXPECT_TRUE(status.ok()) << status.error().text();
}

INSTANTIATE_TEST_SUITE_P(All, RealGarment,
                         testing::Values("characters/mh_adult_cmu_dressed/dress_elegantsuit01_bind.obj",
                                         "garments/cipc_dress_knife/stage.obj", "garments/cipc_dress_knife/drape.obj",
                                         "garments/cipc_skirts/skirt4K.obj",
                                         "garments/cipc_mannequin_rumba/body_frame0_yup.obj",
                                         "garments/makehuman_clothes/female_casualsuit01/female_casualsuit01.obj",
                                         "garments/makehuman_clothes/female_elegantsuit01/female_elegantsuit01.obj",
                                         "garments/makehuman_clothes/female_sportsuit01/female_sportsuit01.obj",
                                         "garments/makehuman_clothes/male_casualsuit01/male_casualsuit01.obj"));

TEST(Obj, Real_garment_cut_anywhere_is_sound_or_refused) {
  const auto path = test::assets_root() / "garments/cipc_dress_knife/stage.obj";
  FT_REQUIRE_FILE(path);
  const auto text = read_text(path);
  ASSERT_TRUE(text.ok());
  for (std::size_t n = 1; n < text->size(); n += text->size() / 61) {
    const auto mesh = parse_obj(std::string_view(*text).substr(0, n), "cut.obj");
    if (mesh) expect_sound(*mesh);
  }
}

}  // namespace
}  // namespace ft

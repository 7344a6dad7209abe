// The preview page in a headless Chromium: what it shows is what the caches say.
#include "baker/commands/preview.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "baker/commands/preview_bake.h"
#include "baker/core/file.h"
#include "baker/record/manifest.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "tests/preview/ask_page.h"
#include "tests/support/assets.h"
#include "tests/support/scripted_body.h"
#include "tests/support/shaped_samples.h"

namespace ft {
namespace {

using test::ScratchFolder;
using test::ShapedSample;

constexpr int k_first = 101, k_frames = 12;

std::vector<Vec3> wave(const Mesh& sheet, int frame) {
  std::vector<Vec3> x = sheet.positions;
  for (Vec3& p : x) p.y() += 0.05 * std::sin(9 * p.x() + 0.5 * frame) + 0.01 * frame;
  return x;
}

/// A bake of a waving sheet above a ball, in both formats; the ball moves on in every frame.
void make_bake(const std::filesystem::path& folder, const Vec3& ball_per_frame = Vec3::Zero()) {
  std::filesystem::create_directories(folder);
  Manifest manifest;
  manifest.version = manifest.build = manifest.fingerprint = "0";
  manifest.shot = "</script>wave.toml";
  manifest.complete = true;
  manifest.first_frame = manifest.first_written = k_first;
  manifest.last_frame = k_first + k_frames - 1;
  Mesh sheet = make_sheet(0.8, 12, 0.4);
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  make_sphere(0.3, 12, 16, points, triangles);
  const Mesh ball = make_triangle_mesh("ball", points, triangles);
  const auto write = [&](const Mesh& mesh, const std::string& name, const std::string& role,
                         const std::string& format) {
    ASSERT_TRUE(write_obj(folder / (name + ".obj"), mesh));
    CacheInfo info;
    info.system = name;
    info.mesh = mesh;
    info.first_frame = k_first;
    info.frame_count = k_frames;
    const std::string file = name + "." + format;
    auto writer = find_cache_format(format)->open_writer(folder / file, info, 0);
    ASSERT_TRUE(writer);
    for (int f = 0; f < k_frames; ++f) {
      std::vector<Vec3> x = wave(mesh, f);
      if (role == "body") {
        x = mesh.positions;
        for (Vec3& p : x) p += f * ball_per_frame;
      }
      ASSERT_TRUE((*writer)->write_frame(x, {}));
    }
    ASSERT_TRUE((*writer)->close());
    manifest.systems.push_back(
        {name, role, "ball", mesh.vertex_count(), mesh.face_count(), name + ".obj", {{format, file, 0, ""}}});
  };
  write(sheet, "sheet", "cloth", "abc");
  write(ball, "ball", "body", "pc2");
  for (int f = 0; f < k_frames; ++f) {
    FrameReport report;
    report.frame = k_first + f;
    report.strain_p99 = 0.01 * f;
    report.smallest_gap = 0.002;
    manifest.frames.push_back(report);
  }
  std::ofstream(folder / "manifest.json") << to_text(manifest);
}

Result<std::string> page_of(const std::vector<std::filesystem::path>& folders) {
  auto page = preview_page({folders, {}});
  if (!page) return page.error();
  return std::move(page->text);
}

TEST(Preview, shows_every_vertex_where_the_cache_has_it_and_plays_slow) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  const ScratchFolder folder;
  make_bake(folder.path());
  const auto page = folder.path() / "page.html";
  ASSERT_EQ(run_preview({{folder.path()}, page}), 0);
  const auto answer = test::ask_page(page, "frame=107&colour=strain&test=sheet:0,57,168");
  ASSERT_TRUE(answer.is_object());
  EXPECT_EQ(answer["frame"], 107);
  auto reader = open_cache(folder.path() / "sheet.abc");
  ASSERT_TRUE(reader);
  std::vector<Vec3f> x;
  ASSERT_TRUE((*reader)->read_frame(107 - k_first, x));
  const std::array<std::size_t, 3> asked{0, 57, 168};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)  // half a step of 16 bits over at most a metre
      EXPECT_NEAR(answer["vertices"]["sheet"][k][axis].get<double>(), x[asked[k]][static_cast<int>(axis)],
                  0.5 / 65535 + 1e-9);
  EXPECT_TRUE(answer["drawn"].get<bool>());
  EXPECT_EQ(answer["plots"],
            nlohmann::json({"strain", "smallest gap", "crossings"}));  // no times: there is no report.json
  EXPECT_EQ(answer["scrubbed"], k_first);
  EXPECT_GT(answer["played"], k_first);
  EXPECT_GT(answer["colours"], 20);  // something is lit, not one flat colour
}

TEST(Preview, draws_the_paths_of_several_bakes_and_plays_the_one_that_is_chosen_slow) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  const ScratchFolder folder;
  make_bake(folder / "still");
  const Vec3 per_frame(0.1, 0, 0.02);
  make_bake(folder / "moved", per_frame);
  const auto page = folder / "page.html";
  ASSERT_EQ(run_preview({{folder / "still", folder / "moved"}, page}), 0);
  const auto answer = test::ask_page(page, "frame=107&bake=moved&test=ball:0");
  ASSERT_TRUE(answer.is_object());
  EXPECT_EQ(answer["bake"], "moved");
  ASSERT_EQ(answer["paths"].size(), 2u);
  const Vec3 apart = (107 - k_first) * per_frame;
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(answer["paths"]["moved"][axis].get<double>() - answer["paths"]["still"][axis].get<double>(),
                apart[static_cast<int>(axis)], 1e-6);
  auto reader = open_cache(folder / "moved" / "ball.pc2");
  ASSERT_TRUE(reader);
  std::vector<Vec3f> x;
  ASSERT_TRUE((*reader)->read_frame(107 - k_first, x));
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(answer["vertices"]["ball"][0][axis].get<double>(), x[0][static_cast<int>(axis)],
                1e-4);  // 16 bits over two metres
  // Of one bake with no prop they are not drawn unless they are asked for.
  ASSERT_EQ(run_preview({{folder / "moved"}, page}), 0);
  EXPECT_TRUE(test::ask_page(page, "test=ball:0")["paths"].empty());
}

/// Adds four leaves of two prototypes to a bake; the third never comes into being.
ShapedSample add_leaves(const std::filesystem::path& folder) {
  ShapedSample sample = test::leaves(k_frames);
  sample.info.first_frame = k_first;
  EXPECT_TRUE(test::write_shaped(*find_cache_format("abc"), folder / "leaves.abc", sample, k_frames, 0));
  std::vector<Mesh> prototypes;
  for (const char* name : {"maple", "oak"})
    prototypes.push_back(
        make_triangle_mesh(name, {{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}}, std::vector<Triangle>{{0, 2, 1}}));
  EXPECT_TRUE(write_obj(folder / "leaves.obj", joined_meshes("leaves", prototypes)));
  auto manifest = read_manifest(folder);
  EXPECT_TRUE(manifest);
  ManifestSystem& system = manifest->systems.emplace_back();
  system.name = "leaves", system.role = "foliage", system.primary = "ball", system.topology = "leaves.obj";
  system.shape = OutputShape::k_instances;
  system.count = 4;
  system.prototypes = {{"maple", 3, 1}, {"oak", 3, 1}};
  system.caches = {{"abc", "leaves.abc", 0, ""}};
  std::ofstream(folder / "manifest.json") << to_text(*manifest);
  return sample;
}

TEST(Preview, holds_prototypes_once_and_of_instances_places_and_turns) {
  const ScratchFolder folder;
  make_bake(folder.path());
  add_leaves(folder.path());
  const auto bake = preview_bake(folder.path());
  ASSERT_TRUE(bake) << bake.error().text();
  const Json& leaves = (*bake)["systems"][2];
  EXPECT_EQ(leaves["vertices"], 4);
  EXPECT_EQ(leaves["positions"].get<std::string>().size(), (4u * 3 * 2 * k_frames + 2) / 3 * 4);
  EXPECT_EQ(leaves["instances"]["turns"].get<std::string>().size(), (4u * 4 * 2 * k_frames + 2) / 3 * 4);
  EXPECT_FALSE(leaves["instances"].contains("sizes"));  // they never change
  ASSERT_EQ(leaves["instances"]["prototypes"].size(), 2u);
  EXPECT_EQ(leaves["instances"]["prototypes"][1]["name"], "oak");
}

TEST(Preview, shows_instances_where_and_how_the_cache_has_them_slow) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  const ScratchFolder folder;
  make_bake(folder.path());
  const ShapedSample sample = add_leaves(folder.path());
  const auto page = folder.path() / "page.html";
  ASSERT_EQ(run_preview({{folder.path()}, page}), 0);
  const auto answer = test::ask_page(page, "frame=107&test=leaves:0,1,2,3");
  ASSERT_TRUE(answer.is_object());
  const FrameData& frame = sample.frames[107 - k_first];
  for (std::size_t i = 0; i < 4; ++i) {
    // The prototype's x axis: turned, and as long as its scale says.
    const Vec3f axis = frame.scales[i].x() * (frame.orientations[i] * Vec3f::UnitX());
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(answer["vertices"]["leaves"][i][k].get<double>(), frame.positions[i][static_cast<int>(k)],
                  0.5 * 4 / 65535 + 1e-6);  // half a step of 16 bits over at most four metres
      EXPECT_NEAR(answer["axes"][i][k].get<double>(), axis[static_cast<int>(k)], 2e-4);  // 16 bits of each component
    }
  }
  EXPECT_TRUE(answer["drawn"].get<bool>());
  EXPECT_GT(answer["played"], k_first);
}

TEST(Preview, bakes_of_one_name_are_told_apart_by_the_folders_above) {
  const ScratchFolder folder;
  make_bake(folder / "a" / "bake");
  make_bake(folder / "b" / "bake");
  const auto page = page_of({folder / "a" / "bake", folder / "b" / "bake"});
  ASSERT_TRUE(page) << page.error().text();
  for (const char* name : {"\"name\":\"a/bake\"", "\"name\":\"b/bake\""})
    EXPECT_NE(page->find(name), std::string::npos) << name;
}

TEST(Preview, tubes_have_a_gap_and_no_strain_and_their_prop_a_path) {
  const ScratchFolder folder;
  make_bake(folder.path());
  std::string manifest = read_text(folder / "manifest.json").value();
  const std::string role = "\"cloth\"";
  manifest.replace(manifest.find(role), role.size(), "\"cords\"");
  std::ofstream(folder / "manifest.json") << manifest;
  const auto bake = preview_bake(folder.path());
  ASSERT_TRUE(bake) << bake.error().text();
  const Json& sheet = (*bake)["systems"][0];
  EXPECT_EQ(sheet["role"], "cords");
  EXPECT_TRUE(sheet.contains("gap"));
  EXPECT_FALSE(sheet.contains("strain"));
  EXPECT_TRUE((*bake)["prop"].get<bool>());
  ASSERT_EQ((*bake)["paths"].size(), 1u);
  EXPECT_EQ((*bake)["paths"][0]["centres"].size(), static_cast<std::size_t>(k_frames));
}

TEST(Preview, holds_every_frame_and_nothing_from_elsewhere) {
  const ScratchFolder folder;
  make_bake(folder.path());
  const auto page = page_of({folder.path()});
  ASSERT_TRUE(page) << page.error().text();
  for (const char* outside : {"src=\"http", "src='http", "href=\"http", "import(", "<link"})
    EXPECT_EQ(page->find(outside), std::string::npos) << outside;
  // A name from a file cannot end the data block.
  EXPECT_NE(page->find("<\\/script>wave.toml"), std::string::npos);
  EXPECT_NE(page->find("\"frame_count\":12"), std::string::npos);
}

TEST(Preview, shows_what_of_a_primary_its_secondaries_do_not_meet) {
  const ScratchFolder folder;
  make_bake(folder.path());
  const auto without = preview_bake(folder.path());
  ASSERT_TRUE(without) << without.error().text();
  EXPECT_FALSE((*without)["systems"][0].contains("absent"));
  EXPECT_TRUE((*without)["systems"][1]["absent"].is_null());
  auto manifest = read_manifest(folder.path());
  ASSERT_TRUE(manifest);
  const int count = (*without)["systems"][1]["vertices"].get<int>();
  // Of the collider's vertices, of which there are more than the drawn body has; and of what is on another primary.
  manifest->frames[3].absent = {{"sheet", {{2, 3}, {count - 1, 10}}}, {"stranger", {{7, 2}}}};
  std::ofstream(folder.path() / "manifest.json") << to_text(*manifest);
  const auto bake = preview_bake(folder.path());
  ASSERT_TRUE(bake) << bake.error().text();
  const Json& absent = (*bake)["systems"][1]["absent"];
  ASSERT_EQ(absent.size(), at(k_frames));
  EXPECT_TRUE(absent[2].empty());
  EXPECT_EQ(absent[3], Json({2, 3, count - 1, 1}));
}

TEST(Preview, refuses_a_folder_that_is_no_bake_and_caches_that_do_not_belong_to_it) {
  const ScratchFolder folder;
  EXPECT_EQ(page_of({folder.path()}).error().kind, ErrorKind::k_input);
  make_bake(folder.path());
  std::filesystem::resize_file(folder.path() / "ball.pc2", 40);
  EXPECT_EQ(page_of({folder.path()}).error().kind, ErrorKind::k_input);
}

}  // namespace
}  // namespace ft

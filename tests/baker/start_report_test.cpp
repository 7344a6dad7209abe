// How garments lie where a bake starts is said before it: crossings, how deep, where, and what is done about them.
#include "baker/plan/start_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "baker/core/file.h"
#include "baker/record/manifest.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

std::string plan_of(const FakeScene& scene, std::vector<std::string> overrides = {}) {
  BakeOptions options = scene.options();
  options.dry_run = true;
  options.overrides = std::move(overrides);
  const BakeResult result = scene.run(options);
  EXPECT_EQ(result.exit_code, 0) << text(result);
  return text(result);
}

void expect_words(const std::string& all, const std::string& words) {
  EXPECT_NE(all.find(words), std::string::npos) << words << "\n in\n" << all;
}

TEST(StartReport, A_garment_beside_the_body_starts_well) {
  const FakeScene scene;
  expect_words(plan_of(scene), "start: no garment crosses the body, itself or another");
}

TEST(StartReport, A_garment_through_the_body_is_named_with_place_and_depth) {
  FakeScene scene;
  scene.write_shot(3, "offset = [-0.2, 0.1, 0.1]");  // x = 0.85: 150 mm inside, its upper and far edges stand out
  const std::string plan = plan_of(scene);
  expect_words(plan, "start: cloth \"sheet\" starts with ");
  expect_words(plan, " crossings with \"box\", 4 vertices up to 150.0 mm inside (vertex ");
  expect_words(plan, " at (0.850, ");
  expect_words(plan, "start: the 3 frames of pre-roll are there to take out what starts through the body");
}

TEST(StartReport, Vertices_have_the_numbers_of_the_file_where_some_are_joined) {
  FakeScene scene;
  Mesh sheet = FakeScene::sheet();
  sheet.positions.insert(sheet.positions.begin(), 3, sheet.positions[0]);  // three more where the first one lies
  for (int& v : sheet.face_vertices) v += 3;
  scene.write_garment(sheet);
  scene.write_shot(3, "weld = 1e-4\noffset = [-0.2, 0.1, 0.1]");
  const std::string plan = plan_of(scene);
  const std::size_t begin = plan.find("(vertex ");
  ASSERT_NE(begin, std::string::npos) << plan;
  const int vertex = std::stoi(plan.substr(begin + 8));
  const Vec3 p = sheet.positions.at(static_cast<std::size_t>(vertex)) + Vec3(-0.2, 0.1, 0.1);
  expect_words(plan, fmt::format("(vertex {} at ({:.3f}, {:.3f}, {:.3f}))", vertex, p.x(), p.y(), p.z()));
}

TEST(StartReport, Without_a_pre_roll_log_and_manifest_say_that_nothing_sorts_it_out) {
  FakeScene scene;
  scene.write_shot(3, "offset = [-0.2, 0.1, 0.1]");
  const std::string words = "there is no pre-roll in which that could be sorted out: give the shot one (preroll = 24 ";
  expect_words(plan_of(scene, {"shot.preroll=0"}), words);
  BakeOptions options = scene.options();
  options.overrides.push_back("shot.preroll=0");
  RecordedProgress progress;
  ASSERT_EQ(bake(options, scene.services(), progress).exit_code, 0);
  expect_words(progress.notes, words);
  expect_words(scene.manifest_text(), words);
}

TEST(StartReport, Cloths_through_each_other_are_named) {
  FakeScene scene;
  const std::string vest = "[cloth.vest]\nmesh = \"sheet.obj\"\nfabric = \"cotton\"\non = \"box\"\n";
  Mesh folded = FakeScene::sheet();
  folded.positions[8] = Vec3(1.05, 0.2, 0.1) + Vec3(0.3, 0, 0);  // its corner goes through the opposite one
  folded.positions[7] += Vec3(-0.02, 0, 0);
  folded.positions[4] += Vec3(0.05, 0, 0);
  scene.write_garment(folded);
  scene.write_shot(3, "", vest + "offset = [0.02, 0, 0]\n");
  expect_words(plan_of(scene), "start: cloth \"sheet\" starts with ");
  expect_words(plan_of(scene), " crossings with cloth \"vest\" (vertex ");
}

TEST(StartReport, The_plan_tells_maps_and_seams) {
  FakeScene scene;
  Mesh sheet = FakeScene::sheet();
  for (const Vec3& p : sheet.positions) sheet.uvs.emplace_back(p.z(), p.y());
  sheet.face_uvs = sheet.face_vertices;
  sheet.groups.push_back({"red", {0, 1, 2, 3}, {1, 1, 1, 0.5}});
  sheet.stitches = {{0, {2, 2}, 0, 0}, {3, {5, 5}, 0, 0}};
  scene.write_garment(sheet);
  scene.write_shot(3, "maps = [{ of = \"thickness\", from = \"red\", low = 1e-3, high = 4e-3 }]\nsewing_time = 0.1");
  const std::string plan = plan_of(scene);
  expect_words(plan, "  map of thickness: 0.001 to 0.004 m, mean 0.002167 m");
  expect_words(plan, "  sewn: 2 stitches in 1 seams, open by up to 1e+03 mm, closed 0.1 s after the start");
  expect_words(plan, "  cut from its pattern at 1 m per unit of vt");
}

TEST(StartReport, Colours_of_0_to_255_are_a_note_of_the_plan) {
  FakeScene scene;
  Mesh sheet = FakeScene::sheet();
  sheet.groups.push_back({"red", {0}, {255}});
  scene.write_garment(sheet);
  const std::string plan = plan_of(scene);
  expect_words(plan, "note: cloth \"sheet\": vertex colours go up to 255: they are read as 0 to 255");
}

TEST(StartReport, A_primary_that_does_not_move_is_said_to_stand_still) {
  const FakeScene scene;
  FakeBehaviour still;
  still.move = [](const Trajectory& box, const ImportRequest& request) -> std::unique_ptr<Trajectory> {
    std::vector<Vec3> corners(8);
    box.bind_pose(corners);
    return std::make_unique<ScriptedBody>(box.surface(), corners, request.preroll, [](double, std::span<Vec3>) {});
  };
  BakeOptions options = scene.options();
  options.dry_run = true;
  expect_words(text(scene.run(options, still)), "primary \"box\" does not move in frames 1-10: is it the right clip");
  EXPECT_EQ(text(scene.run(options)).find("does not move"), std::string::npos);
}

TEST(StartReport, A_preroll_that_is_much_faster_than_the_shot_is_a_note) {
  const FakeScene scene;  // 24 fps, 3 frames of pre-roll
  const auto notes = [&](double metres) {
    FakeBehaviour hasty;
    hasty.move = [metres](const Trajectory& box, const ImportRequest& request) -> std::unique_ptr<Trajectory> {
      std::vector<Vec3> corners(8);
      box.bind_pose(corners);
      return std::make_unique<ScriptedBody>(
          box.surface(), corners, request.preroll, [metres](double time, std::span<Vec3> x) {
            for (Vec3& p : x) p.z() += time < 0 ? -8 * metres * time : 0.1 * time;  // in an eighth of a second
          });
    };
    BakeOptions options = scene.options();
    options.dry_run = true;
    return text(scene.run(options, hasty));
  };
  expect_words(notes(0.5),
               "goes from its bind pose to the first frame at up to 4 m/s, where the shot has 0.1 m/s at most");
  expect_words(notes(0.5), "preroll = 5 is calmer");
  EXPECT_EQ(notes(0.2).find("bind pose to the first frame"), std::string::npos);
}

/// A box that comes from `metres` away in a straight line and then hardly moves; `prerolls` gets those that it was
/// asked for [s].
FakeBehaviour far_away(double metres, std::vector<double>& prerolls) {
  FakeBehaviour out;
  out.move = [metres, &prerolls](const Trajectory& box, const ImportRequest& request) -> std::unique_ptr<Trajectory> {
    std::vector<Vec3> corners(8);
    box.bind_pose(corners);
    prerolls.push_back(request.preroll);
    return std::make_unique<ScriptedBody>(box.surface(), corners, request.preroll,
                                          [metres, s = request.preroll](double time, std::span<Vec3> x) {
                                            for (Vec3& p : x) p.z() += time < 0 ? -metres * time / s : 0.1 * time;
                                          });
  };
  return out;
}

TEST(StartReport, A_preroll_that_the_shot_does_not_name_becomes_a_calm_one) {
  FakeScene scene;  // 24 fps
  std::string shot = read_text(scene.file("shot.toml")).value();
  shot.replace(shot.find("preroll = 3\n"), 12, "");
  std::ofstream(scene.file("shot.toml")) << shot;
  std::vector<double> prerolls;
  const BakeResult baked = scene.run(scene.options(), far_away(4.9, prerolls));  // in 24 frames at 4.9 m/s
  EXPECT_EQ(baked.exit_code, 0) << text(baked);
  EXPECT_EQ(prerolls, (std::vector<double>{1, 2}));
  const auto manifest = read_manifest(scene.folder().path);
  ASSERT_TRUE(manifest);
  EXPECT_EQ(manifest->preroll, 48);
  EXPECT_EQ(manifest->first_written, 1);
  expect_words(scene.manifest_text(), "a shot that names none: it has 48 frames instead");
  prerolls.clear();
  expect_words(text(scene.run(scene.options(), far_away(4.9, prerolls))), "up to date");

  scene.write_shot();
  BakeOptions named = scene.options();
  named.overrides.push_back("shot.preroll=24");
  named.dry_run = true;
  prerolls.clear();
  expect_words(text(scene.run(named, far_away(4.9, prerolls))), "preroll = 48 is calmer");
  EXPECT_EQ(prerolls, std::vector<double>{1});
}

TEST(StartReport, A_part_of_a_shot_with_a_repeated_clip_starts_where_the_shot_does) {
  const FakeScene scene;
  BakeOptions options = scene.options();
  options.overrides.push_back("primary.box.repeat=2");
  options.frames = FrameRange{4, 6};
  const BakeResult result = scene.run(options);
  EXPECT_EQ(result.exit_code, 2);
  expect_words(text(result), "the clip of \"box\" is repeated");
  expect_words(text(result), "has to start at the shot's first frame, 1");
}

}  // namespace
}  // namespace ft::test

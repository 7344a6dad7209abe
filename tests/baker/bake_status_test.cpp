// Up to date, stale and why: a second bake costs nothing, and nothing stale is taken for new.
#include <csignal>
#include <fstream>

#include "baker/core/file.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

/// Bakes, does something, asks why the bake is stale.
std::string reason_after(const FakeScene& scene, const std::function<void()>& change, BakeOptions options) {
  EXPECT_EQ(scene.run().exit_code, 0);
  change();
  options.explain = true;
  const BakeResult result = scene.run(options);
  EXPECT_EQ(result.exit_code, 0);
  return text(result);
}

TEST(BakeStatus, Second_bake_is_skipped_and_says_so) {
  FakeScene scene;
  ASSERT_EQ(scene.run().exit_code, 0) << text(scene.run());
  const auto before = scene.products();
  int solved = 0;
  const BakeResult again = scene.run(scene.options(), {[&](int) { ++solved; }, {}});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(solved, 0);
  ASSERT_EQ(again.lines.size(), 1u);
  EXPECT_EQ(again.lines[0].rfind("up to date: shot.toml, 10 frames in ", 0), 0u) << again.lines[0];
  EXPECT_EQ(scene.products(), before);
}

TEST(BakeStatus, Same_inputs_give_the_same_bytes_in_another_folder) {
  FakeScene scene;
  ASSERT_EQ(scene.run().exit_code, 0);
  BakeOptions other = scene.options();
  other.folder = scene.file("elsewhere");
  ASSERT_EQ(scene.run(other).exit_code, 0);
  EXPECT_EQ(scene.products(), scene.products(other.folder));
  EXPECT_EQ(scene.products().size(), 8u);  // sheet.abc .pc2 .obj, box.abc .obj, box.collider.abc .obj, manifest.json
}

TEST(BakeStatus, Force_bakes_again_to_the_same_bytes) {
  FakeScene scene;
  ASSERT_EQ(scene.run().exit_code, 0);
  const auto before = scene.products();
  BakeOptions options = scene.options();
  options.force = true;
  int solved = 0;
  EXPECT_EQ(scene.run(options, {[&](int) { ++solved; }, {}}).exit_code, 0);
  EXPECT_EQ(solved, 12);  // 3 of pre-roll, then 2..10
  EXPECT_EQ(scene.products(), before);
}

TEST(BakeStatus, Changed_fabric_is_named) {
  FakeScene scene;
  BakeOptions options = scene.options();
  options.overrides = {"cloth.sheet.fabric=denim"};
  const std::string why = reason_after(
      scene, [] {}, options);
  EXPECT_NE(why.find("stale: cloth.sheet.fabric changed from \"cotton\" to \"denim\""), std::string::npos) << why;
  EXPECT_EQ(scene.run(options).exit_code, 0);
  EXPECT_NE(text(scene.run()).find("up to date"), 0u);  // without the override: stale again, baked again
}

TEST(BakeStatus, Changed_mesh_is_named_and_touching_it_is_not_a_change) {
  FakeScene scene;
  Mesh moved = FakeScene::sheet();
  EXPECT_NE(reason_after(
                scene, [&] { scene.write_garment(moved); }, scene.options())
                .find("up to date"),
            std::string::npos);
  moved.positions[0].x() += 1e-3;
  EXPECT_NE(reason_after(
                scene, [&] { scene.write_garment(moved); }, scene.options())
                .find("stale: sheet.obj changed"),
            std::string::npos);
}

TEST(BakeStatus, Damaged_or_lost_cache_is_noticed) {
  FakeScene scene;
  EXPECT_NE(reason_after(
                scene, [&] { std::filesystem::remove(scene.folder().path / "sheet.pc2"); }, scene.options())
                .find("sheet.pc2 is gone"),
            std::string::npos);
  const auto flip = [&] {
    std::fstream file(scene.folder().path / "sheet.pc2", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(100);
    file.put('\x55');
  };
  EXPECT_NE(reason_after(scene, flip, scene.options()).find("sheet.pc2 was changed after the bake"), std::string::npos);
  ASSERT_EQ(scene.run().exit_code, 0);
  EXPECT_NE(text(scene.run()).find("up to date"), std::string::npos);
}

TEST(BakeStatus, Manifest_that_cannot_be_read_is_stale_and_not_fatal) {
  FakeScene scene;
  const auto spoil = [&] { std::ofstream(scene.folder().manifest()) << "{\"program\": 3}"; };
  EXPECT_NE(reason_after(scene, spoil, scene.options()).find("stale: the manifest cannot be read"), std::string::npos);
  EXPECT_EQ(scene.run().exit_code, 0);
}

TEST(BakeStatus, Caches_that_are_no_longer_asked_for_disappear) {
  FakeScene scene;
  scene.write_shot(10, "", "[cache]\nformats = [\"abc\", \"pc2\"]\ncollider = true\n");
  ASSERT_EQ(scene.run().exit_code, 0);
  std::ofstream(scene.folder().path / "notes.txt") << "the artist's own";
  scene.write_shot(10, "", "[cache]\nformats = [\"pc2\"]\ncollider = false\n");
  ASSERT_EQ(scene.run().exit_code, 0);
  std::string names;
  for (const auto& [name, bytes] : scene.products()) names += name + " ";
  EXPECT_EQ(names, "manifest.json notes.txt sheet.obj sheet.pc2 ");
}

TEST(BakeStatus, Gate_judges_a_finished_bake_without_baking_again) {
  FakeScene scene;
  ASSERT_EQ(scene.run().exit_code, 0);
  scene.write_shot(10, "", "[gate]\np99_strain = 0.005\n");
  int solved = 0;
  const BakeResult judged = scene.run(scene.options(), {[&](int) { ++solved; }, {}});
  EXPECT_EQ(judged.exit_code, 4);
  EXPECT_EQ(solved, 0);
  EXPECT_NE(text(judged).find("frame 1: quality gate: p99 strain 0.01 is above 0.005"), std::string::npos)
      << text(judged);
}

TEST(BakeStatus, Range_of_frames_has_its_own_preroll_and_place_in_the_clip) {
  FakeScene scene;
  BakeOptions options = scene.options();
  options.frames = FrameRange{5, 7};
  ASSERT_EQ(scene.run(options).exit_code, 0);
  auto services = scene.services();
  const auto import = services.importer;
  double clip_start = -1, duration = -1;
  services.importer = [&](const ImportRequest& request) {
    clip_start = request.clip_start, duration = request.duration;
    return import(request);
  };
  options.force = true;
  Progress silent;
  ASSERT_EQ(bake(options, services, silent).exit_code, 0);
  EXPECT_DOUBLE_EQ(clip_start, 4 / 24.0);
  EXPECT_DOUBLE_EQ(duration, 2 / 24.0);
}

TEST(BakeStatus, Some_of_the_frames_do_not_replace_a_finished_bake_of_all_unless_forced) {
  FakeScene scene;
  ASSERT_EQ(scene.run().exit_code, 0);
  const auto whole = scene.products();
  BakeOptions part = scene.options();
  part.frames = FrameRange{5, 7};
  for (const bool resume : {false, true}) {
    part.resume = resume;
    const BakeResult refused = scene.run(part);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(
        text(refused).find("there is a finished bake of frames 1-10, which frames 5-7 would replace (bake them into "
                           "a folder of their own with --out, or replace it with --force)"),
        std::string::npos)
        << text(refused);
    EXPECT_EQ(scene.products(), whole);
  }
  part.resume = false;
  for (bool BakeOptions::*look : {&BakeOptions::dry_run, &BakeOptions::explain}) {
    BakeOptions only_looks = part;
    only_looks.*look = true;
    const BakeResult told = scene.run(only_looks);
    EXPECT_EQ(told.exit_code, 0) << text(told);
    EXPECT_NE(text(told).find("this bake would be refused: "), std::string::npos) << text(told);
  }
  BakeOptions elsewhere = part;
  elsewhere.folder = scene.file("part");
  EXPECT_EQ(scene.run(elsewhere).exit_code, 0);
  EXPECT_EQ(scene.products(), whole);
  part.force = true;
  EXPECT_EQ(scene.run(part).exit_code, 0);
  EXPECT_NE(scene.products(), whole);
}

TEST(BakeStatus, A_part_is_replaced_by_the_whole_shot_by_other_frames_and_by_itself) {
  FakeScene scene;
  BakeOptions options = scene.options();
  for (const FrameRange range : {FrameRange{5, 7}, {8, 10}, {7, 9}, {6, 10}, {1, 10}}) {
    options.frames = range;
    EXPECT_EQ(scene.run(options).exit_code, 0) << range.first;
  }
  scene.write_shot(10, "", "[cache]\ncollider = false\n");
  EXPECT_EQ(scene.run(options).exit_code, 0) << "the same frames, other settings";
  scene.write_shot(5);
  EXPECT_EQ(scene.run().exit_code, 0) << "the shot itself has become shorter";
}

TEST(BakeStatus, A_bake_that_was_not_finished_is_replaced_by_some_of_its_frames) {
  FakeScene scene;
  RecordedProgress progress;
  progress.on_frame = [](int f) { f == 4 ? void(std::raise(SIGINT)) : void(); };
  ASSERT_EQ(bake(scene.options(), scene.services(), progress).exit_code, 130);
  BakeOptions part = scene.options();
  part.frames = FrameRange{2, 3};
  EXPECT_EQ(scene.run(part).exit_code, 0);
}

TEST(BakeStatus, Dry_run_writes_nothing) {
  FakeScene scene;
  BakeOptions options = scene.options();
  options.dry_run = true;
  const BakeResult plan = scene.run(options);
  EXPECT_EQ(plan.exit_code, 0) << text(plan);
  EXPECT_NE(text(plan).find("cloth \"sheet\" on \"box\": 9 vertices, 8 faces"), std::string::npos) << text(plan);
  EXPECT_NE(text(plan).find("not baked"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(scene.folder().path));
}

}  // namespace
}  // namespace ft::test

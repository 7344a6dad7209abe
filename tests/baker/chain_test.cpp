// Cloth on cloth, baked for real: a sheet that is pulled about by a ball, and a badge on the sheet.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "baker/core/parallel.h"
#include "baker/judge/judge_caches.h"
#include "baker/record/manifest.h"
#include "baker/run/bake.h"
#include "baker/systems/cloth/pins.h"
#include "collision/check/crossings.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

constexpr double k_above = 5e-3;  ///< of the badge above the sheet, in the files [m]
constexpr double k_size = 0.1;    ///< of the badge [m]
constexpr int k_last_frame = 8;
constexpr int k_stage_frames = k_last_frame + 3;  ///< that are solved for in a stage, with a pre-roll of 4

class Chain : public testing::Test {
 protected:
  Chain() {
    EXPECT_TRUE(write_obj(folder_ / "sheet.obj", make_sheet(0.4, 10, 0.2)).ok());
    EXPECT_TRUE(write_obj(folder_ / "badge.obj", make_sheet(k_size, 6, 0.2 + k_above)).ok());
    write_shot(k_sheet + k_badge);
  }
  void write_shot(const std::string& cloths, int preroll = 4) const {
    std::ofstream(folder_ / "shot.toml") << "[shot]\nframes = \"1-" << k_last_frame
                                         << "\"\nfps = 24\npreroll = " << preroll
                                         << "\n[primary.ball]\nshape = \"sphere\"\nradius = 0.15\n"
                                            "position = [0, 0.04, 0]\nvelocity = [0.4, 0.3, 0]\n"
                                         << cloths << "[cache]\nformats = [\"pc2\"]\n";
  }
  BakeResult run(BakeOptions options, Progress& progress) const {
    options.shot_file = folder_ / "shot.toml";
    const Importer none = [](const ImportRequest&) -> Result<ImportedPrimary> { return input_error("no files here"); };
    return bake(options, {none, make_group_solver}, progress);
  }
  BakeResult run(BakeOptions options) const {
    Progress silent;
    return run(std::move(options), silent);
  }
  BakeOptions into(const std::string& name) const {
    BakeOptions out;
    out.folder = folder_ / name;
    return out;
  }
  std::map<std::string, std::string> products(const std::string& name) const {
    return FakeScene().products(folder_ / name);
  }
  std::vector<std::vector<Vec3>> frames(const std::string& bake, const std::string& system) const {
    auto cache = open_cache(folder_ / bake / (system + ".pc2"));
    EXPECT_TRUE(cache) << cache.error().text();
    std::vector<std::vector<Vec3>> out;
    std::vector<Vec3f> x;
    for (int i = 0; cache && i < (*cache)->info().frame_count; ++i) {
      EXPECT_TRUE((*cache)->read_frame(i, x).ok());
      auto& frame = out.emplace_back();
      for (const Vec3f& p : x) frame.push_back(p.cast<double>());
    }
    return out;
  }

  /// after: frames of all stages, after which a bake of its own is interrupted.
  void expect_resumed(const std::vector<int>& all_after) const {
    ASSERT_EQ(run(into("undisturbed")).exit_code, 0);
    const auto expected = products("undisturbed");
    for (const int after : all_after) {
      RecordedProgress progress;
      int count = 0;
      progress.on_frame = [&](int) { ++count == after ? void(std::raise(SIGINT)) : void(); };
      const std::string name = "stopped" + std::to_string(after);
      const BakeResult stopped = run(into(name), progress);
      ASSERT_EQ(stopped.exit_code, 130) << after << text(stopped);
      const auto half = read_manifest(folder_ / name);
      ASSERT_TRUE(half) << half.error().text();
      EXPECT_FALSE(half->complete);
      BakeOptions options = into(name);
      options.resume = true;
      RecordedProgress resumed;
      const BakeResult done = run(options, resumed);
      ASSERT_EQ(done.exit_code, 0) << after << text(done);
      EXPECT_EQ(resumed.frames.size(), at(2 * k_stage_frames - after)) << "what was done is not done again";
      EXPECT_EQ(products(name), expected) << after;
    }
  }

  const std::string k_sheet = "[cloth.sheet]\nmesh = \"sheet.obj\"\non = \"ball\"\npins = [{ vertices = \"0-10\" }]\n";
  const std::string k_badge =
      "[cloth.badge]\nmesh = \"badge.obj\"\non = \"cloth.sheet\"\npins = [{ vertices = \"0-6\" }]\n";
  ScratchFolder folder_;
};

TEST_F(Chain, A_badge_stays_on_its_sheet_and_crosses_nothing) {
  RecordedProgress progress;
  const BakeResult baked = run(into("out"), progress);
  ASSERT_EQ(baked.exit_code, 0) << text(baked);
  const auto sheet = frames("out", "sheet"), badge = frames("out", "badge");
  ASSERT_EQ(sheet.size(), at(k_last_frame));
  ASSERT_EQ(badge.size(), sheet.size());
  const auto sheet_triangles = triangulate(make_sheet(0.4, 10, 0)),
             badge_triangles = triangulate(make_sheet(k_size, 6, 0));
  double moved = 0;
  for (std::size_t f = 0; f < sheet.size(); ++f) {
    EXPECT_TRUE(crossings_between(badge[f], badge_triangles, sheet[f], sheet_triangles).empty()) << f;
    const auto distance = distances_to_surface(badge[f], sheet[f], sheet_triangles);
    for (std::size_t v = 0; v < 7; ++v) EXPECT_NEAR(distance[v], k_above, 2e-3) << f << " " << v;
    for (const double d : distance) EXPECT_LT(d, k_size) << f << ": it turns about its upper edge, no farther";
    moved = std::max(moved, (sheet[f][60] - sheet[0][60]).norm());
  }
  EXPECT_GT(moved, 0.03) << "the sheet has to take the badge somewhere";
  EXPECT_NE(progress.notes.find("stage 2 of 2: cloth \"badge\" on \"cloth.sheet\""), std::string::npos)
      << progress.notes;
}

TEST_F(Chain, The_manifest_has_the_systems_and_frames_of_all_stages_and_check_judges_them) {
  ASSERT_EQ(run(into("out")).exit_code, 0);
  const auto manifest = read_manifest(folder_ / "out");
  ASSERT_TRUE(manifest) << manifest.error().text();
  EXPECT_TRUE(manifest->complete);
  std::vector<std::string> names;
  for (const ManifestSystem& s : manifest->systems) names.push_back(s.name);
  EXPECT_EQ(std::count(names.begin(), names.end(), "sheet"), 1);
  const auto badge = std::ranges::find(manifest->systems, "badge", &ManifestSystem::name);
  ASSERT_NE(badge, manifest->systems.end());
  EXPECT_EQ(badge->primary, "cloth.sheet");
  EXPECT_NE(std::ranges::find(badge->meets, "sheet"), badge->meets.end());
  EXPECT_EQ(manifest->frames.size(), at(k_last_frame + 4));
  for (const FrameReport& frame : manifest->frames) {
    EXPECT_EQ(frame.crossings_body, 0) << frame.frame;
    EXPECT_EQ(frame.absent_vertices, 0) << frame.frame;
  }
  const auto judged = judge_caches(folder_ / "out");
  ASSERT_TRUE(judged) << judged.error().text();
  ASSERT_EQ(judged->frames.size(), at(k_last_frame));
  for (const FrameReport& frame : judged->frames) {
    EXPECT_EQ(frame.crossings_body, 0) << frame.frame;
    EXPECT_EQ(frame.deepest_drawn, 0) << "nobody is inside a sheet; frame " << frame.frame;
  }
  // Nothing is left of what the second stage was baked from.
  for (const char* name : {"stages", "sheet.motion.pc2", "checkpoint"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/.state" / name)) << name;
}

TEST_F(Chain, The_order_in_the_file_changes_nothing) {
  ASSERT_EQ(run(into("a")).exit_code, 0);
  write_shot(k_badge + k_sheet);
  ASSERT_EQ(run(into("b")).exit_code, 0);
  const auto a = products("a"), b = products("b");
  for (const char* name : {"sheet.pc2", "badge.pc2"}) EXPECT_EQ(a.at(name), b.at(name)) << name;
}

TEST_F(Chain, The_carrier_is_what_it_is_without_what_it_carries) {
  ASSERT_EQ(run(into("both")).exit_code, 0);
  write_shot(k_sheet);
  ASSERT_EQ(run(into("alone")).exit_code, 0);
  EXPECT_EQ(products("both").at("sheet.pc2"), products("alone").at("sheet.pc2"));
}

TEST_F(Chain, The_number_of_threads_changes_nothing) {
  std::map<std::string, std::string> expected;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const std::string name = "threads" + std::to_string(threads);
    EXPECT_EQ(run(into(name)).exit_code, 0);
    if (expected.empty()) expected = products(name);
    EXPECT_EQ(products(name), expected) << threads;
  }
}

TEST_F(Chain, Interrupted_in_the_second_stage_it_goes_on_to_the_same_bytes) {
  expect_resumed({k_stage_frames + 6});
}

TEST_F(Chain, Interrupted_in_any_stage_it_goes_on_to_the_same_bytes_slow) {
  expect_resumed({3, k_stage_frames, k_stage_frames + 1, 2 * k_stage_frames - 1});
}

TEST_F(Chain, When_the_record_of_the_first_stage_is_gone_it_starts_anew) {
  ASSERT_EQ(run(into("undisturbed")).exit_code, 0);
  RecordedProgress progress;
  int count = 0;
  progress.on_frame = [&](int) { ++count == k_last_frame + 6 ? void(std::raise(SIGINT)) : void(); };
  ASSERT_EQ(run(into("out"), progress).exit_code, 130);
  std::filesystem::remove(folder_ / "out/.state/stages");
  BakeOptions options = into("out");
  options.resume = true;
  RecordedProgress resumed;
  ASSERT_EQ(run(options, resumed).exit_code, 0);
  EXPECT_NE(resumed.notes.find("starting anew"), std::string::npos) << resumed.notes;
  EXPECT_EQ(products("out"), products("undisturbed"));
}

TEST_F(Chain, A_change_of_the_carrier_makes_the_bake_stale_and_none_leaves_it_up_to_date) {
  ASSERT_EQ(run(into("out")).exit_code, 0);
  EXPECT_NE(text(run(into("out"))).find("up to date"), std::string::npos);
  BakeOptions options = into("out");
  options.overrides = {"cloth.sheet.fabric=denim"};
  options.explain = true;
  EXPECT_NE(text(run(options)).find("stale: cloth.sheet.fabric changed"), std::string::npos) << text(run(options));
}

TEST_F(Chain, A_dry_run_names_the_stages_and_says_what_it_cannot_know) {
  BakeOptions options = into("out");
  options.dry_run = true;
  const std::string said = text(run(options));
  EXPECT_NE(said.find("stage 1 of 2: cloth \"sheet\" on \"ball\""), std::string::npos) << said;
  EXPECT_NE(said.find("stage 2 of 2: cloth \"badge\" on \"cloth.sheet\""), std::string::npos) << said;
  EXPECT_NE(said.find("is not known yet"), std::string::npos) << said;
}

TEST_F(Chain, What_is_wrong_with_a_later_stage_shows_before_the_first_is_baked) {
  write_shot(k_sheet + "[cloth.badge]\nmesh = \"badge.obj\"\non = \"cloth.sheet\"\npins = [{ group = \"nowhere\" }]\n");
  RecordedProgress progress;
  const BakeResult refused = run(into("out"), progress);
  EXPECT_EQ(refused.exit_code, 2) << text(refused);
  EXPECT_NE(text(refused).find("nowhere"), std::string::npos);
  EXPECT_TRUE(progress.frames.empty());
}

TEST_F(Chain, Without_a_preroll_it_starts_where_the_carrier_starts) {
  write_shot(k_sheet + k_badge, 0);
  ASSERT_EQ(run(into("out")).exit_code, 0);
  const auto sheet = frames("out", "sheet"), badge = frames("out", "badge");
  EXPECT_NEAR((badge[0][0] - sheet[0][0]).y(), k_above, 1e-6);
}

TEST_F(Chain, Cloth_on_the_primary_meets_what_it_names_of_earlier_stages) {
  // A second sheet falls on the first, which does not feel it.
  EXPECT_TRUE(write_obj(folder_ / "upper.obj", make_sheet(0.2, 8, 0.23)).ok());
  write_shot(k_sheet + "[cloth.upper]\nmesh = \"upper.obj\"\non = \"ball\"\nmeets = [\"cloth.sheet\"]\n");
  const BakeResult baked = run(into("out"));
  ASSERT_EQ(baked.exit_code, 0) << text(baked);
  write_shot(k_sheet);
  ASSERT_EQ(run(into("alone")).exit_code, 0);
  EXPECT_EQ(products("out").at("sheet.pc2"), products("alone").at("sheet.pc2"));
  const auto sheet = frames("out", "sheet"), upper = frames("out", "upper");
  const auto sheet_triangles = triangulate(make_sheet(0.4, 10, 0)), own = triangulate(make_sheet(0.2, 8, 0));
  for (std::size_t f = 0; f < sheet.size(); ++f)
    EXPECT_TRUE(crossings_between(upper[f], own, sheet[f], sheet_triangles).empty()) << f;
}

}  // namespace
}  // namespace ft::test

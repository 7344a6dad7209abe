// [water.NAME] from the shot file to its caches: all models have the same bytes with any number of threads and after
// interruptions, what floats goes where the water takes it, and what makes no sense is refused with its place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "baker/commands/base64.h"
#include "baker/commands/compare.h"
#include "baker/commands/preview_bake.h"
#include "baker/commands/volumes.h"
#include "baker/core/file.h"
#include "baker/judge/judge_caches.h"
#include "baker/plan/plan.h"
#include "baker/record/manifest.h"
#include "baker/systems/water/water_bed.h"
#include "baker/systems/water/water_model.h"
#include "io/cache/cache.h"
#include "io/volume/vdb_read.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

constexpr const char* k_pond =
    "[water.pond]\nposition = [0, 0, 0]\nsize = [4, 0, 4]\ndepth = 2\ncell = 0.125\nfloats = [\"float*\"]\n";
constexpr const char* k_puddle =
    "[water.puddle]\nposition = [0, -0.2, 0]\nsize = [1, 0, 1]\ndepth = 0.02\ncell = 0.05\nmeets = [\"stamp\"]\n";

constexpr const char* k_paper =
    "[water.ripples]\nmodel = \"paper\"\nposition = [0, 0, 0]\nsize = [3, 0, 3]\ndepth = 0.6\ncell = 0.1\n"
    "floats = [\"float*\"]\n";

class WaterBakeTest : public testing::Test {
 protected:
  /// A block comes down on a puddle, and a ball falls into a pond.
  void write_shot(const std::string& water, int frames = 12,
                  const std::string& cache = "formats = [\"abc\", \"pc2\"]\n") const {
    std::ofstream(folder_ / "shot.toml")
        << "[shot]\nframes = \"1-" << frames
        << "\"\nfps = 24\npreroll = 0\n[primary.stamp]\nshape = \"box\"\nsize = [0.3, 0.2, 0.3]\n"
           "position = [0, 0.1, 0]\nvelocity = [0, -1.2, 0]\nrelease = 9999\n"
           "[primary.float_ball]\nshape = \"sphere\"\nradius = 0.3\nmass = 50\nposition = [0, 0.4, 0]\n"
        << water << "[cache]\n"
        << cache;
  }
  BakeResult run(const std::string& name) const { return bake_shot_in(folder_.path(), name); }
  std::string refusal(const std::string& water) const {
    write_shot(water);
    const auto made = plan_shot_in(folder_.path());
    return made ? "it was planned" : made.error().text();
  }

  ScratchFolder folder_;
};

TEST_F(WaterBakeTest, Threads_and_interruptions_change_no_byte) {
  write_shot(std::string(k_pond) + k_puddle);
  expect_threads_and_interruptions_change_no_byte(folder_.path(), 7);
  for (const char* file : {"pond.abc", "pond.pc2", "puddle.abc", "puddle_droplets.abc", "float_ball.abc"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "one" / file)) << file;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "one/puddle_droplets.pc2"))
      << "PC2 cannot hold points that come and go";
}

TEST_F(WaterBakeTest, What_floats_goes_where_the_water_takes_it_and_no_water_is_lost) {
  write_shot(k_pond, 96);
  ASSERT_EQ(run("out").exit_code, 0);
  const auto manifest = read_manifest(folder_ / "out");
  ASSERT_TRUE(manifest) << manifest.error().text();
  double error = 0;
  for (const FrameReport& frame : manifest->frames)
    if (frame.own.contains("water_error")) error = std::max(error, frame.own.at("water_error"));
  EXPECT_LT(error, 1e-12);
  auto reader = open_cache(folder_ / "out/float_ball.abc");
  ASSERT_TRUE(reader) << reader.error().text();
  std::vector<Vec3f> x;
  const auto height = [&](int frame) {
    EXPECT_TRUE((*reader)->read_frame(frame, x));
    double sum = 0;
    for (const Vec3f& p : x) sum += p.y() / static_cast<double>(x.size());
    return sum;
  };
  EXPECT_NEAR(height(0), 0.4, 1e-3);
  // 50 of 113 kg: it swims a little higher than its middle.
  EXPECT_LT(std::abs(height(95)), 0.15);
  double lowest = 1;
  for (int f = 0; f < 96; ++f) lowest = std::min(lowest, height(f));
  EXPECT_LT(lowest, -0.05) << "it dives in";
  EXPECT_GT(lowest, -0.6) << "and does not fall through";
  const auto judged = judge_caches(folder_ / "out");
  ASSERT_TRUE(judged) << judged.error().text();
  for (const FrameReport& frame : judged->frames) EXPECT_TRUE(frame.finite);
}

TEST_F(WaterBakeTest, The_water_of_the_paper_is_baked_where_it_is_named_and_says_what_it_gets_wrong) {
  write_shot(k_paper, 8);
  const auto plan = plan_shot_in(folder_.path());
  ASSERT_TRUE(plan) << plan.error().text();
  std::string notes;
  for (const std::string& note : plan->notes) notes += note + "\n";
  EXPECT_NE(notes.find("carries no momentum along"), std::string::npos) << notes;
  EXPECT_NE(notes.find("too fast in the paper's water of 0.6 m"), std::string::npos) << notes;
  expect_threads_and_interruptions_change_no_byte(folder_.path(), 5);
  for (const char* file : {"ripples.abc", "ripples_droplets.abc", "float_ball.abc"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "one" / file)) << file;
}

TEST_F(WaterBakeTest, Leaves_lie_on_water_that_was_baked_before_them) {
  write_shot(std::string(k_pond) +
                 "[leaves.fall]\ncount = 12\nsize = [3, 0, 3]\nposition = [0, 0.03, 0]\non = \"water.pond\"\n",
             36);
  const auto plan = plan_shot_in(folder_.path());
  ASSERT_TRUE(plan) << plan.error().text();
  ASSERT_EQ(run("out").exit_code, 0);
  auto reader = open_cache_of_any_shape(folder_ / "out/fall.abc");
  ASSERT_TRUE(reader) << reader.error().text();
  FrameData leaves;
  ASSERT_TRUE((*reader)->read(35, leaves));
  ASSERT_EQ(leaves.positions.size(), 12u);
  for (const Vec3f& p : leaves.positions) EXPECT_LT(std::abs(p.y()), 0.1f) << "in 1.5 s one would fall by far more";
  const auto judged = judge_caches(folder_ / "out");
  ASSERT_TRUE(judged) << judged.error().text();
  EXPECT_EQ(judged->frames.size(), 36u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/pond.abc"));
}

TEST_F(WaterBakeTest, Leaves_on_water_have_the_same_bytes_with_any_threads_and_after_interruptions) {
  write_shot(std::string(k_pond) +
                 "[leaves.fall]\ncount = 12\nsize = [3, 0, 3]\nposition = [0, 0.03, 0]\non = \"water.pond\"\n",
             8);
  // In the second stage.
  expect_threads_and_interruptions_change_no_byte(folder_.path(), 11);
}

TEST_F(WaterBakeTest, Droplets_of_two_bakes_are_compared_by_their_ids) {
  write_shot(k_puddle, 8);
  ASSERT_EQ(run("a").exit_code, 0);
  ASSERT_EQ(run("b").exit_code, 0);
  write_shot(std::string(k_puddle) + "seed = 9\n", 8);
  ASSERT_EQ(run("c").exit_code, 0);
  const auto droplets = [&](const char* other) {
    return compare_paths(folder_ / "a/puddle_droplets.abc", folder_ / other / "puddle_droplets.abc", 0).at(0);
  };
  const CompareReport same = droplets("b"), different = droplets("c");
  EXPECT_EQ(same.verdict, CompareVerdict::k_equal) << same.reason;
  ASSERT_TRUE(same.points);
  EXPECT_GT(same.points->common, 10u);
  EXPECT_EQ(different.verdict, CompareVerdict::k_different);
}

TEST_F(WaterBakeTest, The_page_has_as_many_droplets_in_each_frame_as_the_cache) {
  write_shot(k_puddle, 8);
  ASSERT_EQ(run("out").exit_code, 0);
  const auto page = preview_bake(folder_ / "out", 1e6);
  ASSERT_TRUE(page) << page.error().text();
  auto cache = open_cache_of_any_shape(folder_ / "out/puddle_droplets.abc");
  ASSERT_TRUE(cache) << cache.error().text();
  std::vector<std::uint32_t> counts;
  std::size_t most = 0;
  FrameData frame;
  for (int f = 0; f < 8; ++f) {
    ASSERT_TRUE((*cache)->read(f, frame));
    counts.push_back(static_cast<std::uint32_t>(frame.positions.size()));
    most = std::max(most, frame.positions.size());
  }
  EXPECT_GT(most, 10u);
  bool found = false;
  for (const Json& system : (*page)["systems"]) {
    if (system["name"] == "puddle") {
      EXPECT_TRUE(system["liquid"].get<bool>());
    }
    if (system["name"] != "puddle_droplets") continue;
    found = true;
    EXPECT_EQ(system["vertices"].get<std::size_t>(), most);
    EXPECT_EQ(system["points"]["counts"].get<std::string>(), base64_of(counts));
  }
  EXPECT_TRUE(found);
}

TEST_F(WaterBakeTest, What_its_surface_has_by_name_goes_from_the_caches_to_whoever_looks_at_them) {
  write_shot(std::string(k_pond) + k_puddle, 12);
  const auto plan = plan_shot_in(folder_.path());
  ASSERT_TRUE(plan) << plan.error().text();
  std::string notes;
  for (const std::string& note : plan->notes) notes += note + "\n";
  EXPECT_NE(notes.find("its \"wet\" is not in its pc2 cache"), std::string::npos) << notes;
  ASSERT_EQ(run("out").exit_code, 0);
  const auto page = preview_bake(folder_ / "out", 1e6);
  ASSERT_TRUE(page) << page.error().text();
  for (const auto& [system, name] : {std::pair("pond", "foam"), {"puddle", "wet"}}) {
    auto cache = open_cache(folder_ / "out" / (std::string(system) + ".abc"));
    ASSERT_TRUE(cache) << cache.error().text();
    EXPECT_EQ((*cache)->info().content.scalars, std::vector<std::string>{name});
    std::vector<std::uint8_t> wanted;
    FrameData frame;
    for (int f = 0; f < 12; ++f) {
      ASSERT_TRUE((*cache)->read(f, frame));
      ASSERT_EQ(frame.scalars.at(0).size(), frame.positions.size());
      for (const float x : frame.scalars[0]) wanted.push_back(static_cast<std::uint8_t>(std::lround(255 * x)));
    }
    const Json& systems = (*page)["systems"];
    const auto shown = std::find_if(systems.begin(), systems.end(), [&](const Json& s) { return s["name"] == system; });
    ASSERT_NE(shown, systems.end());
    EXPECT_EQ((*shown)["scalars"][name].get<std::string>(), base64_of(wanted));
  }
  const auto manifest = read_manifest(folder_ / "out");
  ASSERT_TRUE(manifest) << manifest.error().text();
  const auto pond = std::ranges::find(manifest->systems, "pond", &ManifestSystem::name);
  ASSERT_NE(pond, manifest->systems.end());
  EXPECT_EQ(pond->scalars, std::vector<std::string>{"foam"});
  // A cache without them is not this bake's; one with others differs.
  auto old = open_cache(folder_ / "out/pond.abc");
  ASSERT_TRUE(old);
  CacheInfo info = (*old)->info();
  std::vector<FrameData> frames(12);
  for (int f = 0; f < 12; ++f) ASSERT_TRUE((*old)->read(f, frames[at(f)]));
  old->reset();
  const auto rewrite = [&] {
    auto writer = find_cache_format("abc")->open_writer(folder_ / "other.abc", info, 0);
    ASSERT_TRUE(writer) << writer.error().text();
    for (const FrameData& frame : frames) ASSERT_TRUE((*writer)->write_frame(frame.view()));
    ASSERT_TRUE((*writer)->close());
  };
  frames[5].scalars[0][7] += 0.25f;
  rewrite();
  const CompareReport other = compare_paths(folder_ / "out/pond.abc", folder_ / "other.abc", 1e-3).at(0);
  EXPECT_EQ(other.verdict, CompareVerdict::k_different);
  ASSERT_EQ(other.scalars.both.size(), 1u);
  EXPECT_NEAR(other.scalars.both[0].max, 0.25, 1e-6);
  EXPECT_EQ(other.scalars.both[0].frame, 6);
  EXPECT_EQ(other.scalars.both[0].vertex, 7);
  info.content.scalars.clear();
  for (FrameData& frame : frames) frame.scalars.clear();
  rewrite();
  std::filesystem::copy_file(folder_ / "other.abc", folder_ / "out/pond.abc",
                             std::filesystem::copy_options::overwrite_existing);
  const auto judged = judge_caches(folder_ / "out");
  ASSERT_FALSE(judged);
  EXPECT_NE(judged.error().text().find("has the scalars [], the manifest says [foam]"), std::string::npos)
      << judged.error().text();
}

TEST_F(WaterBakeTest, Its_frames_are_written_as_volumes_with_the_same_bytes_whose_velocities_are_read_back) {
  write_shot(k_pond, 12);
  ASSERT_EQ(run("out").exit_code, 0);
  for (const char* name : {"a", "b"}) {
    const auto lines = write_volumes({.folder = folder_ / "out", .output = folder_ / name});
    ASSERT_TRUE(lines) << lines.error().text();
    EXPECT_NE(lines->front().find("pond.0001.vdb"), std::string::npos);
    EXPECT_NE(lines->at(1).find("in Blender: Rotation X = 90"), std::string::npos);
  }
  for (const char* file : {"pond.0001.vdb", "pond.0012.vdb"}) {
    const auto a = read_file(folder_ / "a" / file), b = read_file(folder_ / "b" / file);
    ASSERT_TRUE(a && b) << file;
    EXPECT_TRUE(*a == *b) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a/pond.0013.vdb"));
  const auto fastest = [&](const char* file) {
    const auto velocity = read_vdb_velocity(folder_ / "a" / file, "vel", {});
    EXPECT_TRUE(velocity) << velocity.error().text();
    float out = 0;
    for (const Vec3f& v : velocity->velocities) out = std::max(out, v.norm());
    return out;
  };
  EXPECT_LT(fastest("pond.0001.vdb"), fastest("pond.0012.vdb")) << "it knows the frame after it only";
  EXPECT_GT(fastest("pond.0012.vdb"), 0.05f) << "the ball has come down";
  EXPECT_NE(write_volumes({.folder = folder_ / "a", .output = {}}).error().text().find("manifest"), std::string::npos);
}

TEST_F(WaterBakeTest, A_shot_asks_for_volumes_which_are_made_once) {
  write_shot(k_pond, 3, "formats = [\"abc\"]\nvolumes = true\n");
  for (int turn = 0; turn < 2; ++turn) {
    const BakeResult result = run("out");
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.volumes, folder_ / "out") << turn;
  }
  const auto last = folder_ / "out/pond.0003.vdb";
  const auto made = [&] {
    EXPECT_TRUE(write_volumes({.folder = folder_ / "out", .output = {}, .keep = true}));
    return std::filesystem::last_write_time(last);
  };
  const auto first = made();
  EXPECT_EQ(made(), first);
  std::filesystem::last_write_time(folder_ / "out/pond.abc", first + std::chrono::seconds(1));
  EXPECT_NE(made(), first) << "its cache is newer";
  write_shot(k_pond, 3);
  EXPECT_TRUE(run("out").volumes.empty());
  for (const auto& [water, cache, words] :
       {std::tuple(k_pond, "formats = [\"pc2\"]", "made from Alembic"),
        {"[leaves.oak]\non = \"stamp\"\ncount = 20\nsize = [1, 2, 1]\n", "formats = [\"abc\"]", "has none"}}) {
    write_shot(water, 3, std::string(cache) + "\nvolumes = true\n");
    const auto planned = plan_shot_in(folder_.path());
    ASSERT_FALSE(planned);
    EXPECT_NE(planned.error().text().find(words), std::string::npos) << planned.error().text();
  }
}

TEST_F(WaterBakeTest, What_makes_no_sense_is_refused_with_its_place) {
  const std::string start = "[water.pond]\nposition = [0, 0, 0]\n";
  for (const auto& [lines, words] :
       {std::pair("size = [4, 0, 4]\n", "depth is missing"),
        {"size = [0, 0, 4]\ndepth = 1\n", "size has no area"},
        {"size = [4, 0, 4]\ndepth = 1\nbed = \"ground.obj\"\n", "depth does not go with bed"},
        {"size = [4, 0, 4]\nmodel = \"pond\"\nbed = \"ground.obj\"\n", "bed is for shallow water"},
        {"size = [4, 0, 4]\ndepth = 1\nfloat_drag = 1\n", "floats is empty"},
        {"size = [4, 0, 4]\ndepth = 1\nfloats = [\"stamp\"]\n", "its mass is missing"},
        {"size = [4, 0, 4]\ndepth = 1\nfloats = [\"nobody\"]\n", "nobody"},
        {"size = [0.2, 0, 0.2]\ndepth = 1\nfloats = [\"float_ball\"]\nmeets = []\n", "and the pond 0.2 x 0.2 m"},
        {"size = [0.2, 0, 0.2]\ndepth = 1\n", "\"stamp\" is 0.3 x 0.3 m, larger than the water of 0.2 x 0.2 m"},
        {"size = [900, 0, 900]\ndepth = 0.1\ncell = 0.01\n", "90000 x 90000 cells of 0.01 m"}}) {
    const std::string said = refusal(start + lines);
    EXPECT_NE(said.find(words), std::string::npos) << lines << said;
  }
}

TEST(WaterModel, Depth_and_size_advise_one) {
  EXPECT_EQ(advise_water(0.02, 2, 3, false).model, "shallow");
  EXPECT_EQ(advise_water(5, 20, 10, false).model, "pond");
  EXPECT_EQ(advise_water(5, 20, 10, true).model, "shallow");
  EXPECT_NEAR(advise_water(5, 20, 10, false).too_fast, std::sqrt(2 * std::numbers::pi * 5) - 1, 1e-6);
  EXPECT_NE(doubt_of_model("shallow", advise_water(5, 20, 10, false), 5), "");
  EXPECT_NE(doubt_of_model("pond", advise_water(0.02, 2, 3, false), 0.02), "");
  EXPECT_EQ(doubt_of_model("pond", advise_water(5, 20, 10, false), 5), "");
  EXPECT_NE(doubt_of_model("paper", advise_water(5, 20, 10, false), 5), "");
  EXPECT_GT(limits_of_model("paper", 2).size(), limits_of_model("shallow", 2).size());
}

TEST(WaterBed, Is_the_uppermost_surface_under_each_cell) {
  const WaterGrid grid{{0, 0}, 0.1, 10, 10};
  // A slope over all of it, and above a part of that a table.
  const std::vector<Vec3> x{{0, 0, 0},     {1, 1, 0},     {1, 1, 1},     {0, 0, 1},
                            {0.2, 2, 0.2}, {0.2, 2, 0.4}, {0.4, 2, 0.4}, {0.4, 2, 0.2}};
  const std::vector<Triangle> t{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  const WaterBed bed = bed_under(grid, x, t);
  EXPECT_EQ(bed.uncovered, 0);
  for (int k = 0; k < 10; ++k)
    for (int i = 0; i < 10; ++i) {
      const bool table = (i == 2 || i == 3) && (k == 2 || k == 3);
      EXPECT_NEAR(bed.height[at(10 * k + i)], table ? 2 : 0.1 * (i + 0.5), 1e-12) << i << " " << k;
    }
  const WaterBed part = bed_under({{0.5, 0}, 0.1, 10, 10}, x, t);
  EXPECT_EQ(part.uncovered, 50);
  EXPECT_EQ(part.height[9], 2);
}

TEST(WaterBed, What_can_run_off_over_the_edge_has_run_off) {
  const WaterGrid grid{{0, 0}, 0.1, 9, 9};
  std::vector<double> bed(81, 0.0);
  // A ring with water in it and water around.
  for (int k = 2; k <= 6; ++k)
    for (int i = 2; i <= 6; ++i)
      if (i == 2 || i == 6 || k == 2 || k == 6) bed[at(9 * k + i)] = 0.3;
  const std::vector<double> held = depths_that_stay(grid, bed, 0.2);
  double sum = 0;
  for (const double depth : held) sum += depth;
  EXPECT_NEAR(sum, 9 * 0.2, 1e-12);
  EXPECT_EQ(held[at(9 * 4 + 4)], 0.2);
  bed[9 * 4 + 2] = 0.1;  // a breach
  for (const double depth : depths_that_stay(grid, bed, 0.2)) EXPECT_EQ(depth, 0);
}

}  // namespace
}  // namespace ft::test

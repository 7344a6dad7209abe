// Leaves baked for real: their caches are the same whatever the threads and interruptions, and check judges them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "baker/core/file.h"
#include "baker/judge/judge_caches.h"
#include "baker/record/manifest.h"
#include "baker/run/wind_file.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

constexpr int k_last_frame = 16;

class LeavesBakeTest : public testing::Test {
 protected:
  /// A ball rolls over a floor of leaves, at a distance to the side.
  void write_shot(double aside = 0) const {
    std::ofstream(folder_ / "shot.toml")
        << "[shot]\nframes = \"1-" << k_last_frame
        << "\"\nfps = 24\npreroll = 0\n[primary.floor]\nshape = \"ground\"\n[primary.ball]\nshape = \"sphere\"\n"
           "radius = 0.15\nvelocity = [4, 0, 0]\nposition = [-1.2, 0.152, "
        << aside
        << "]\nrelease = 9999\n[leaves.oak]\n"
           "on = \"floor\"\ncount = 200\nsize = [2, 0, 0.6]\ncamera = [-1, 0, 0]\nnear = 0.7\n[wind.wake]\nkind = "
           "\"wake\"\nof = \"ball\"\n"
           "[cache]\nformats = [\"abc\", \"pc2\"]\n";
  }
  BakeResult run(const std::string& name, int threads = 1, int interrupted_after = 0, bool resume = false) const {
    return bake_shot_in(folder_.path(), name, threads, interrupted_after, resume);
  }

  ScratchFolder folder_;
};

TEST_F(LeavesBakeTest, Threads_and_interruptions_change_no_byte) {
  write_shot();
  expect_threads_and_interruptions_change_no_byte(folder_.path(), 7);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "one/oak.abc"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "one/oak.pc2")) << "PC2 cannot hold instances";
  for (const char* file : {"one/oak_near.abc", "one/oak_near.pc2"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << "those near the camera are a mesh";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "one" / k_wind_file));
}

TEST_F(LeavesBakeTest, The_air_is_drawn_around_leaves_where_nothing_else_is) {
  std::ofstream(folder_ / "shot.toml") << "[shot]\nframes = \"1-4\"\npreroll = 0\n[primary.floor]\nshape = \"ground\"\n"
                                          "[leaves.oak]\ncount = 5\nsize = [1, 0, 1]\nposition = [8, 0, 0]\n"
                                          "[wind]\nvelocity = [3, 0, 0]\n[cache]\nformats = [\"abc\"]\n";
  ASSERT_EQ(run("out").exit_code, 0);
  const auto text = read_text(folder_ / "out" / k_wind_file, 1 << 20);
  ASSERT_TRUE(text) << text.error().text();
  const auto air = nlohmann::json::parse(*text);
  ASSERT_GT(air["places"].size(), 10u);
  for (const auto& place : air["places"]) {
    EXPECT_GT(place[0], 7000) << "mm";
    EXPECT_LT(place[0], 9500);
  }
  EXPECT_EQ(air["velocities"][0][0], 300) << "cm/s";
}

TEST_F(LeavesBakeTest, Check_finds_no_crossing_in_the_caches_and_one_where_bodies_were_moved) {
  write_shot();
  ASSERT_EQ(run("out").exit_code, 0);
  const auto manifest = read_manifest(folder_ / "out");
  ASSERT_TRUE(manifest) << manifest.error().text();
  double woken = 0;
  for (const FrameReport& frame : manifest->frames) {
    EXPECT_EQ(frame.crossings_body, 0) << frame.frame;
    if (frame.own.contains("leaves_woken")) woken += frame.own.at("leaves_woken");
  }
  EXPECT_GT(woken, 0) << "the ball rolls over some";
  auto judged = judge_caches(folder_ / "out");
  ASSERT_TRUE(judged) << judged.error().text();
  ASSERT_EQ(judged->frames.size(), at(k_last_frame));
  for (const FrameReport& frame : judged->frames) EXPECT_EQ(frame.crossings_body, 0) << frame.frame;

  // The same leaves beside a ball that rolls elsewhere.
  write_shot(0.2);
  ASSERT_EQ(run("aside").exit_code, 0);
  for (const char* file : {"ball.abc", "ball.obj"})
    std::filesystem::copy_file(folder_ / "aside" / file, folder_ / "out" / file,
                               std::filesystem::copy_options::overwrite_existing);
  judged = judge_caches(folder_ / "out");
  ASSERT_TRUE(judged) << judged.error().text();
  int crossings = 0;
  for (const FrameReport& frame : judged->frames) crossings += frame.crossings_body;
  EXPECT_GT(crossings, 0);
}

}  // namespace
}  // namespace ft::test

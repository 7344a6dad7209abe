// [hair.NAME] from the shot file to its caches: strands grow on what they are on, threads and interruptions change no
// byte, check judges them, and what makes no sense is refused with its place.
#include <gtest/gtest.h>

#include <fstream>

#include "baker/judge/judge_caches.h"
#include "baker/plan/plan.h"
#include "baker/record/manifest.h"
#include "baker/systems/hair/hair_group.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

constexpr int k_last_frame = 10;
constexpr const char* k_hair = "[hair.tuft]\non = \"ball\"\nguides = \"tuft.obj\"\nvertices = 12\n";

class HairBakeTest : public testing::Test {
 protected:
  /// A ball that flies past with a tuft of nine strands on its top, and a beam across their way.
  HairBakeTest() {
    std::ofstream tuft(folder_ / "tuft.obj");
    for (int k = 0; k < 9; ++k) {
      const double x = 0.01 * (k % 3 - 1), z = 0.01 * (k / 3 - 1), top = std::sqrt(0.15 * 0.15 - x * x - z * z);
      for (int i = 0; i < 5; ++i) tuft << "v " << x * (1 + i) << " " << top + 0.02 * i << " " << z * (1 + i) << "\n";
      tuft << "l";
      for (int i = 0; i < 5; ++i) tuft << " " << 5 * k + i + 1;
      tuft << "\n";
    }
  }
  void write_shot(const std::string& lines = k_hair, double speed = 2) const {
    std::ofstream(folder_ / "shot.toml")
        << "[shot]\nframes = \"1-" << k_last_frame
        << "\"\nfps = 24\npreroll = 0\n[primary.ball]\nshape = \"sphere\"\nradius = 0.15\nvelocity = [" << speed
        << ", 0, 0]\nrelease = 9999\n[primary.beam]\nshape = \"box\"\nsize = [0.3, 0.1, 0.6]\n"
           "position = [0.6, 0.25, 0]\nrelease = 9999\n"
        << lines << "[cache]\nformats = [\"abc\", \"pc2\"]\n";
  }
  BakeResult run(const std::string& name, int threads = 1, int interrupted_after = 0, bool resume = false) const {
    return bake_shot_in(folder_.path(), name, threads, interrupted_after, resume);
  }
  std::string refusal(const std::string& lines) const {
    write_shot(lines);
    const auto made = plan_shot_in(folder_.path());
    return made ? "it was planned" : made.error().text();
  }

  ScratchFolder folder_;
};

TEST_F(HairBakeTest, Threads_and_interruptions_change_no_byte) {
  write_shot();
  expect_threads_and_interruptions_change_no_byte(folder_.path(), 4);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "one/tuft.abc"));
}

TEST_F(HairBakeTest, What_grows_from_a_region_and_strands_between_its_guides_have_the_same_bytes_and_are_outside) {
  write_shot(
      "[hair.tuft]\non = \"ball\"\nregion = [0, 0.15, 0]\nregion_radius = 0.12\ncount = 40\nlength = 0.12\n"
      "length_variation = 0.2\nclump_size = 0.03\nstrands = 300\nvertices = 12\n");
  expect_threads_and_interruptions_change_no_byte(folder_.path(), 4);
  const auto manifest = read_manifest(folder_ / "one");
  ASSERT_TRUE(manifest) << manifest.error().text();
  EXPECT_TRUE(std::ranges::any_of(manifest->systems, [](const auto& s) { return s.name == "tuft_strands"; }));
  const auto judged = judge_caches(folder_ / "one");
  ASSERT_TRUE(judged) << judged.error().text();
  for (const FrameReport& frame : judged->frames) {
    EXPECT_EQ(frame.inside_body, 0) << frame.frame;
    EXPECT_LT(frame.strain_p99, 0.02) << frame.frame;
  }
}

TEST_F(HairBakeTest, Strands_follow_their_roots_and_check_finds_them_outside_until_a_body_is_moved_into_them) {
  write_shot();
  ASSERT_EQ(run("out").exit_code, 0);
  const auto manifest = read_manifest(folder_ / "out");
  ASSERT_TRUE(manifest) << manifest.error().text();
  for (const FrameReport& frame : manifest->frames) {
    EXPECT_EQ(frame.inside_body, 0) << frame.frame;
    EXPECT_LT(frame.strain_max, 0.001) << frame.frame;
  }
  const auto judged = judge_caches(folder_ / "out");
  ASSERT_TRUE(judged) << judged.error().text();
  ASSERT_EQ(judged->frames.size(), at(k_last_frame));
  for (const FrameReport& frame : judged->frames) EXPECT_EQ(frame.inside_body, 0) << frame.frame;

  write_shot(k_hair, 1.2);
  ASSERT_EQ(run("slower").exit_code, 0);
  for (const char* file : {"ball.abc", "ball.obj"})
    std::filesystem::copy_file(folder_ / "slower" / file, folder_ / "out" / file,
                               std::filesystem::copy_options::overwrite_existing);
  const auto moved = judge_caches(folder_ / "out");
  ASSERT_TRUE(moved) << moved.error().text();
  int inside = 0;
  for (const FrameReport& frame : moved->frames) inside += frame.inside_body;
  EXPECT_GT(inside, 0);
}

TEST_F(HairBakeTest, A_share_of_the_guides_is_chosen_evenly_and_material_comes_from_the_shot) {
  write_shot(std::string(k_hair) + "count = 3\nstiffness = 4\nwidth = 2e-4\nposition = [0, 0.001, 0]\n");
  auto made = plan_shot_in(folder_.path());
  ASSERT_TRUE(made) << made.error().text();
  const auto& own = dynamic_cast<const HairSpec&>(*made->shot().secondaries.at(0));
  const auto read = hair_setup(made->shot(), own, 0, {}, *made);
  ASSERT_TRUE(read) << read.error().text();
  const HairSetup& setup = *read;
  ASSERT_EQ(setup.strands.size(), 3u);
  EXPECT_EQ(setup.strands[0].id, 0u);
  EXPECT_EQ(setup.strands[1].id, 3u);
  EXPECT_EQ(setup.strands[2].id, 6u);
  EXPECT_EQ(setup.strands[0].positions.size(), 12u);
  EXPECT_EQ(setup.strands[0].width, 2e-4);
  EXPECT_EQ(setup.material.stiffness, 4);
  const double top = std::sqrt(0.15 * 0.15 - 2e-4);
  EXPECT_NEAR((setup.strands[0].positions[0] - Vec3(-0.01, top + 0.001, -0.01)).norm(), 0, 1e-5);
}

TEST_F(HairBakeTest, Strands_are_left_out_by_their_numbers) {
  write_shot(std::string(k_hair) + "leave_out = \"0, 2-7\"\n");
  auto made = plan_shot_in(folder_.path());
  ASSERT_TRUE(made) << made.error().text();
  const auto setup =
      hair_setup(made->shot(), dynamic_cast<const HairSpec&>(*made->shot().secondaries.at(0)), 0, {}, *made);
  ASSERT_TRUE(setup) << setup.error().text();
  ASSERT_EQ(setup->strands.size(), 2u);
  EXPECT_EQ(setup->strands[0].id, 1u);
  EXPECT_EQ(setup->strands[1].id, 8u);
  EXPECT_NE(refusal(std::string(k_hair) + "leave_out = \"9\"\n").find("the file has 9, from 0"), std::string::npos);
  EXPECT_NE(refusal(std::string(k_hair) + "leave_out = \"0-8\"\n").find("all of its 9"), std::string::npos);
  EXPECT_NE(refusal(std::string(k_hair) + "leave_out = \"a\"\n").find("leave_out"), std::string::npos);
}

TEST_F(HairBakeTest, What_makes_no_sense_is_refused_with_its_place) {
  std::ofstream(folder_ / "empty.obj") << "v 0 0 0\n";
  std::ofstream(folder_ / "far.obj") << "v 5 0 0\nv 5 0.1 0\nv 5 0.2 0\nl 1 2 3\n";
  for (const auto& [lines, words] : {std::pair("vertices = 12\n", "guides are missing"),
                                     {"guides = \"none.obj\"\n", "none.obj"},
                                     {"guides = \"empty.obj\"\n", "empty.obj"},
                                     {"guides = \"tuft.obj\"\nvertices = 2\n", "vertices"},
                                     {"guides = \"tuft.obj\"\nscale = 0\n", "scale"}}) {
    const std::string said = refusal(std::string("[hair.tuft]\non = \"ball\"\n") + lines);
    EXPECT_NE(said.find(words), std::string::npos) << lines << said;
  }
  for (const auto& [lines, words] :
       {std::pair("region = [0, 0.15, 0]\n", "go together"),
        {"guides = \"tuft.obj\"\nregion = [0, 0, 0]\nregion_radius = 0.1\n", "it has one of them"},
        {"guides = \"tuft.obj\"\ncurl_radius = 0.01\n", "grows from a region"},
        {"region = [0, 5, 0]\nregion_radius = 0.1\n", "the nearest vertex of the body is"},
        {"region = [0, 0.15, 0]\nregion_radius = 0.1\nparting_at = [0, 0, 0]\n", "parting_along"},
        {"region_mesh = \"tuft.obj\"\n", "tuft.obj"}}) {
    const std::string said = refusal(std::string("[hair.tuft]\non = \"ball\"\n") + lines);
    EXPECT_NE(said.find(words), std::string::npos) << lines << said;
  }
  const std::string far = refusal("[hair.tuft]\non = \"ball\"\nguides = \"far.obj\"\n");
  EXPECT_NE(far.find("from the surface that it should grow on"), std::string::npos) << far;
}

}  // namespace
}  // namespace ft::test

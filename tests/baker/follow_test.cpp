// What follows with a spring's lag: vertices against the closed form, joints through a bake and back from the files
// that it writes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "baker/record/cache_track.h"
#include "baker/systems/follow/follow_group.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

constexpr double k_speed = 0.8;  ///< of the box [m/s]

/// The box at rest, which sets off along x at the shot's first frame.
std::unique_ptr<Trajectory> setting_off(const Trajectory& box, const ImportRequest&) {
  std::vector<Vec3> points(8);
  box.bind_pose(points);
  return std::make_unique<ScriptedBody>(box.surface(), points, box.preroll(), [](double time, std::span<Vec3> x) {
    for (Vec3& p : x) p.x() += k_speed * std::max(0.0, time);
  });
}

std::string follow_lines(const std::string& more) {
  return "[follow.belly]\nweights = \"weights.csv\"\nfrequency = 2\ndamping_ratio = 0.25\nmax_distance = 10\non = "
         "\"box\"\n" +
         more;
}

TEST(Follow, Vertices_lag_behind_by_the_closed_form_and_by_their_weight) {
  FakeScene scene;
  std::ofstream(scene.file("weights.csv")) << "1\n0.5\n0\n0\n0\n0\n0\n0\n";
  scene.write_shot(12, "", follow_lines(""));
  ASSERT_EQ(scene.run(scene.options(), {.move = setting_off}).exit_code, 0);
  const auto manifest = read_manifest(scene.folder().path);
  ASSERT_TRUE(manifest);
  const double w = 2 * std::numbers::pi * 2, z = 0.25, a = w * std::sqrt(1 - z * z);
  for (const ManifestSystem& system : manifest->systems) {
    if (system.name != "belly") continue;
    EXPECT_EQ(system.role, "follow");
    const auto track = open_track(scene.folder().path, system, *manifest);
    ASSERT_TRUE(track) << track.error().text();
    for (int frame = 0; frame < 12; ++frame) {
      std::vector<Vec3> x;
      ASSERT_TRUE(track->read(frame, x));
      const double t = frame / 24.0, lag = -k_speed * std::exp(-z * w * t) * std::sin(a * t) / a;
      EXPECT_NEAR(x[0].x(), k_speed * t + lag, 1e-6) << frame;
      EXPECT_NEAR(x[1].x(), 1 + k_speed * t + 0.5 * lag, 1e-6) << frame;
      EXPECT_NEAR(x[2].x(), k_speed * t, 1e-6) << "weight 0";
    }
    return;
  }
  FAIL() << "nothing follows";
}

TEST(Follow, What_it_measures_is_in_the_frames_and_can_be_a_gate) {
  FakeScene scene;
  std::ofstream(scene.file("weights.csv")) << "1\n1\n1\n1\n1\n1\n1\n1\n";
  scene.write_shot(12, "", follow_lines("[gate]\nmost = { follow_lag = 0.01 }\n"));
  const BakeResult stopped = scene.run(scene.options(), {.move = setting_off});
  EXPECT_EQ(stopped.exit_code, 4);
  EXPECT_NE(text(stopped).find("follow_lag"), std::string::npos) << text(stopped);
  EXPECT_NE(scene.manifest_text().find("\"follow_lag\""), std::string::npos);
  scene.write_shot(12, "", follow_lines("[gate]\nmost = { follow_lga = 0.01 }\n"));
  const BakeResult refused = scene.run(scene.options(), {.move = setting_off});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(text(refused).find("did you mean \"follow_lag\"?"), std::string::npos) << text(refused);
}

TEST(Follow, What_cannot_follow_is_refused_with_what_would) {
  FakeScene scene;
  const auto fault = [&](const std::string& lines) {
    scene.write_shot(4, "", "[follow.tail]\non = \"box\"\n" + lines);
    const BakeResult out = scene.run();
    EXPECT_NE(out.exit_code, 0) << lines;
    return text(out);
  };
  EXPECT_NE(fault("").find("bones or weights is missing"), std::string::npos);
  EXPECT_NE(fault("bones = [\"tail_*\"]\n").find("has no joints"), std::string::npos);
  std::ofstream(scene.file("weights.csv")) << "0\n0\n0\n0\n0\n0\n0\n0\n";
  EXPECT_NE(fault("weights = \"weights.csv\"\n").find("all weights are 0"), std::string::npos);
  EXPECT_NE(fault("weights = \"weights.csv\"\nmax_angle = 5\n").find("max_angle does not go with weights"),
            std::string::npos);
  std::ofstream(scene.file("weights.csv")) << "1\n1\n";
  EXPECT_NE(fault("weights = \"weights.csv\"\n").find("weights.csv"), std::string::npos);
}

/// A pelvis that swings to and fro, with two legs and a tail of three joints.
std::string bvh_with_tail(int frames, double fps) {
  std::string out =
      "HIERARCHY\nROOT Hips\n{\n OFFSET 0 100 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
      "Yrotation\n";
  const auto joint = [&](const std::string& name, const std::string& offset) {
    out += " JOINT " + name + "\n {\n OFFSET " + offset + "\n CHANNELS 3 Zrotation Xrotation Yrotation\n";
  };
  const auto end = [&](const std::string& offset, int depth) {
    out += " End Site\n {\n OFFSET " + offset + "\n }\n";
    for (int k = 0; k < depth; ++k) out += " }\n";
  };
  joint("Spine", "0 25 0"), joint("Head", "0 35 0"), end("0 20 0", 2);
  joint("LeftUpLeg", "12 0 0"), joint("LeftLeg", "0 -45 0"), joint("LeftFoot", "0 -45 0"), end("0 0 15", 3);
  joint("RightUpLeg", "-12 0 0"), joint("RightLeg", "0 -45 0"), joint("RightFoot", "0 -45 0"), end("0 0 15", 3);
  joint("tail_1", "0 0 -15"), joint("tail_2", "0 0 -20"), joint("tail_3", "0 0 -20"), end("0 0 -20", 3);
  out += "}\nMOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: " + std::to_string(1 / fps) + "\n";
  for (int f = 0; f < frames; ++f) {
    const double t = f / fps;
    out += std::to_string(40 * std::sin(4 * t)) + " 100 0 0 0 " + std::to_string(50 * std::sin(5 * t));
    for (int k = 0; k < 11; ++k) out += " 0 0 0";
    out += "\n";
  }
  return out;
}

class FollowedTail : public testing::Test {
 protected:
  /// The cached positions of the character with its tail at a frame, from 0.
  std::vector<Vec3> bake(const std::string& fps, int frames, int frame, const std::string& file = "cat.bvh",
                         const std::string& follow = "[follow.tail]\nbones = [\"tail_*\"]\n",
                         const std::string& system_name = "tail") {
    std::ofstream(scratch_ / "cat.bvh") << bvh_with_tail(200, 100);
    std::ofstream(scratch_ / "sheet.obj") << "v 0 0.4 0.6\nv 0.1 0.4 0.6\nv 0 0.5 0.6\nf 1 2 3\n";
    std::ofstream(scratch_ / "shot.toml")
        << "[shot]\nframes = \"1-" << frames << "\"\nfps = " << fps << "\npreroll = 0\n[primary.cat]\nfile = \"" << file
        << "\"\nclip_start = 0.5\nbody = \"capsules\"\nunit_scale = 0.01\nup = \"y\"\n"
        << follow;
    BakeOptions options;
    options.shot_file = scratch_ / "shot.toml";
    options.folder = scratch_ / ("out_" + system_name + fps);
    Progress silent;
    const BakeResult result = ft::bake(options, {import_primary, make_group_solver}, silent);
    EXPECT_EQ(result.exit_code, 0) << text(result);
    folder_ = options.folder;
    std::vector<Vec3> x;
    const auto manifest = read_manifest(options.folder);
    if (!manifest) return x;
    for (const ManifestSystem& system : manifest->systems)
      if (system.name == system_name) {
        const auto track = open_track(options.folder, system, *manifest);
        EXPECT_TRUE(track) << track.error().text();
        if (track) {
          EXPECT_TRUE(track->read(frame, x));
        }
      }
    return x;
  }
  ScratchFolder scratch_;
  std::filesystem::path folder_;
};

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double out = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

TEST_F(FollowedTail, It_lags_and_the_rest_of_the_body_does_not) {
  const auto tail = bake("25", 20, 12),
             body = bake("25", 20, 12, "cat.bvh", "[follow.tail]\nbones = [\"tail_*\"]\n", "cat");
  EXPECT_GT(farthest(tail, body), 0.05);
  std::size_t moved = 0;
  for (std::size_t v = 0; v < body.size(); ++v) moved += (tail[v] - body[v]).norm() > 1e-5;
  EXPECT_GT(moved, 10u);
  EXPECT_LT(moved, body.size() / 2);
}

TEST_F(FollowedTail, It_does_not_depend_on_the_frame_rate) {
  const auto coarse = bake("25", 20, 12), fine = bake("100", 80, 48), other = bake("50", 40, 24);
  const auto body = bake("25", 20, 12, "cat.bvh", "[follow.tail]\nbones = [\"tail_*\"]\n", "cat");
  EXPECT_LT(farthest(coarse, fine), 0.01 * farthest(coarse, body));
  EXPECT_LT(farthest(other, fine), 0.01 * farthest(coarse, body));
}

TEST_F(FollowedTail, The_files_that_are_written_play_what_was_baked) {
  const auto baked = bake("25", 20, 12);
  const std::filesystem::path bvh = folder_ / "tail_follow.bvh";
  ASSERT_TRUE(std::filesystem::exists(bvh));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "tail_follow.glb"));
  std::filesystem::copy_file(bvh, scratch_ / "adjusted.bvh");
  // With an amount of 0 it is the animation of the file.
  const auto played = bake("25", 20, 12, "adjusted.bvh", "[follow.again]\nbones = [\"tail_*\"]\namount = 0\n", "again");
  EXPECT_LT(farthest(played, baked), 2e-4);
}

TEST_F(FollowedTail, Sections_on_one_primary_add_up) {
  const std::string two = "[follow.first]\nbones = [\"tail_*\"]\n[follow.second]\nbones = [\"Head\"]\namount = 0\n";
  const auto tail = bake("25", 20, 12), both = bake("25", 20, 12, "cat.bvh", two, "second");
  EXPECT_LT(farthest(tail, both), 1e-5);
}

TEST_F(FollowedTail, A_pattern_that_names_no_joint_says_which_was_meant) {
  std::ofstream(scratch_ / "cat.bvh") << bvh_with_tail(200, 100);
  std::ofstream(scratch_ / "shot.toml")
      << "[shot]\nframes = \"1-2\"\n[primary.cat]\nfile = \"cat.bvh\"\n[follow.tail]\nbones = [\"tial_*\"]\n";
  BakeOptions options;
  options.shot_file = scratch_ / "shot.toml";
  options.folder = scratch_ / "out";
  Progress silent;
  const BakeResult result = ft::bake(options, {import_primary, make_group_solver}, silent);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(text(result).find("names no joint"), std::string::npos) << text(result);
}

}  // namespace
}  // namespace ft::test

// The Trajectory's promises: pre-roll from the placed bind pose to the first frame, continuity, thread safety; FBX
// against the same clip as Collada; BVH against forward kinematics written here.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "baker/core/parallel.h"
#include "io/import/body/bind.h"
#include "io/import/character/pose.h"
#include "io/import/import.h"
#include "io/import/import_cache.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

std::vector<Vec3> positions(const Trajectory& t, double time) {
  std::vector<Vec3> p(static_cast<std::size_t>(t.surface().vertex_count()));
  t.sample(time, p);
  return p;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

Vec3 middle(const std::vector<Vec3>& p) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : p) sum += x;
  return sum / static_cast<double>(p.size());
}

/// Characters whose start lies far from their bind pose, turned and in mid-air.
std::vector<ImportRequest> requests() {
  std::vector<ImportRequest> out(4);
  const auto root = test::assets_root();
  out[0].file = root / "characters/mh_adult_cmu_dressed/adult_cmu01.glb", out[0].clip = "01_03_climb_hang_swing",
  out[0].clip_start = 20;
  out[1].file = root / "mocap/cmu_01_playground/01_01.bvh", out[1].clip_start = 9, out[1].body = "capsules";
  out[2].file = root / "characters/ozz_pab_fbx/skeleton.fbx",
  out[2].animation = root / "characters/ozz_pab_fbx/run.fbx", out[2].clip_start = 0.3;
  out[3].file = root / "mocap/animateddrawings_fair1_child/dab.bvh", out[3].clip_start = 1, out[3].body = "capsules";
  for (ImportRequest& r : out) r.preroll = 1.5;
  return out;
}

TEST(Preroll, Starts_at_the_placed_bind_pose_and_ends_in_the_first_frame) {
  for (const ImportRequest& request : requests()) {
    FT_REQUIRE_FILE(request.file);
    auto primary = import_primary(request);
    ASSERT_TRUE(primary) << primary.error().text();
    const Trajectory& t = *primary->trajectory;
    EXPECT_EQ(t.preroll(), 1.5);
    std::vector<Vec3> bind(static_cast<std::size_t>(t.surface().vertex_count()));
    t.bind_pose(bind);
    for (Vec3& p : bind) p = t.bind_to_start() * p;
    EXPECT_LT(distance(positions(t, -1.5), bind), 1e-9) << request.file;
    EXPECT_LT(distance(positions(t, -99), bind), 1e-9) << request.file;

    const auto first = positions(t, 0);
    // The run-up has the first frame's pose, further back.
    for (const double time : {-0.6, -0.3, -1e-9}) {
      auto now = positions(t, time);
      const Vec3 back = now[0] - first[0];
      for (Vec3& p : now) p -= back;
      EXPECT_LT(distance(now, first), 1e-9) << request.file << time;
    }
    EXPECT_GT(distance(bind, first), 0.05) << request.file;

    // Upright: only turned about the vertical.
    EXPECT_LT((t.bind_to_start().linear() * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-12);
    // The body stays where it is while it takes the pose.
    const auto taken = positions(t, -0.6);
    for (double time = -1.5; time <= -0.6; time += 0.05)
      EXPECT_LT((middle(positions(t, time)) - middle(taken)).norm(), 0.35) << request.file << time;
    // No jumps: the fastest moment of a smooth step over 0.9 s is 1.5 / 0.9 of the mean.
    auto before = positions(t, -1.5);
    for (double time = -1.49; time < 0; time += 0.01) {
      auto now = positions(t, time);
      EXPECT_LT(distance(before, now), 0.01 * 3 * M_PI * 1.5 / 0.9) << request.file << time;
      before = std::move(now);
    }
  }
}

TEST(Preroll, Ends_with_the_speed_that_the_shot_begins_with) {
  ImportRequest request = requests()[2];  // a runner
  FT_REQUIRE_FILE(request.file);
  auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  const Trajectory& t = *primary->trajectory;
  const double h = 1.0 / 120;
  const auto speed = [&](double time) -> Vec3 {
    return (middle(positions(t, time + h)) - middle(positions(t, time))) / h;
  };
  EXPECT_GT(speed(0).norm(), 2.0);
  EXPECT_LT((speed(-h) - speed(0)).norm(), 0.15 * speed(0).norm());
  EXPECT_LT(speed(-0.6).norm(), 0.05 * speed(0).norm());
  for (double time = -0.6; time < 0; time += h) EXPECT_LE(speed(time).norm(), speed(0).norm() * 1.1) << time;
}

TEST(Preroll, Of_no_length_shows_the_first_frame) {
  ImportRequest request = requests()[1];
  FT_REQUIRE_FILE(request.file);
  request.preroll = 0;
  auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  EXPECT_EQ(distance(positions(*primary->trajectory, -1), positions(*primary->trajectory, 0)), 0);
}

TEST(Trajectory, Speed_and_start_choose_the_moment_of_the_clip) {
  ImportRequest request = requests()[1];
  FT_REQUIRE_FILE(request.file);
  request.clip_start = 2;
  auto slow = import_primary(request);
  request.clip_start = 2.5, request.speed = 2;
  auto fast = import_primary(request);
  ASSERT_TRUE(slow && fast);
  EXPECT_LT(distance(positions(*slow->trajectory, 1.3), positions(*fast->trajectory, 0.4)), 1e-9);
}

TEST(Trajectory, Gives_the_same_bytes_on_many_threads_at_once) {
  const ImportRequest request = requests()[0];
  FT_REQUIRE_FILE(request.file);
  auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  const Trajectory& t = *primary->trajectory;
  std::vector<std::vector<Vec3>> alone, together(24);
  for (int i = 0; i < 24; ++i) alone.push_back(positions(t, -1.5 + 0.2 * i));
  const ThreadLimit threads(4);
  parallel_tasks(24, [&](std::size_t i) { together[i] = positions(t, -1.5 + 0.2 * static_cast<double>(i)); });
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(distance(alone[i], together[i]), 0);
}

/// World positions of all named nodes, in metres.
std::map<std::string, Vec3> node_places(const Character& c, double time) {
  const ClipPose pose(c, &c.clips.at(0));
  std::vector<Mat4> locals(c.nodes.size()), globals(c.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  pose.sample(c.clips[0].start + time, locals, morphs);
  globals_from_locals(c.nodes, locals, globals);
  std::map<std::string, Vec3> out;
  for (std::size_t i = 0; i < c.nodes.size(); ++i)
    out[c.nodes[i].name] = c.file_unit * c.file_axes * Vec3(globals[i].topRightCorner<3, 1>());
  return out;
}

TEST(Formats, The_same_walk_as_fbx_and_as_collada_is_the_same) {
  const auto folder = test::assets_root() / "characters/ozz_pab_fbx";
  FT_REQUIRE_FILE(folder / "walk.dae");
  auto fbx = load_character(folder / "walk.fbx", {}, {}), dae = load_character(folder / "walk.dae", {}, {});
  ASSERT_TRUE(fbx) << fbx.error().text();
  ASSERT_TRUE(dae) << dae.error().text();
  for (const double time : {0.0, 0.2, 0.5, 1.0, 1.3}) {
    const auto a = node_places(fbx->character, time), b = node_places(dae->character, time);
    int shared = 0;
    // Relative to the hips: the exporters need not agree on the scene's origin.
    const auto hips_a = a.find("Hips"), hips_b = b.find("Hips");
    ASSERT_TRUE(hips_a != a.end() && hips_b != b.end());
    for (const auto& [name, place] : a) {
      const auto other = b.find(name);
      if (other == b.end() || place.norm() > 5) continue;
      ++shared;
      EXPECT_LT((place - other->second).norm(), 1e-3) << name << " at " << time;
    }
    EXPECT_GT(shared, 40);
  }
}

/// Forward kinematics of a BVH frame, straight from the text.
std::map<std::string, Vec3> bvh_places(const std::filesystem::path& file, int frame) {
  std::ifstream in(file);
  struct Joint {
    std::string name;
    int parent;
    Vec3 offset;
    std::vector<std::string> channels;
  };
  std::vector<Joint> joints;
  std::vector<int> stack;
  std::string word;
  while (in >> word && word != "MOTION") {
    if (word == "ROOT" || word == "JOINT" || word == "End") {
      std::string name;
      in >> name;
      joints.push_back({word == "End" ? "" : name, stack.empty() ? -1 : stack.back(), Vec3::Zero(), {}});
    } else if (word == "{") {
      stack.push_back(static_cast<int>(joints.size()) - 1);
    } else if (word == "}") {
      stack.pop_back();
    } else if (word == "OFFSET") {
      in >> joints.back().offset.x() >> joints.back().offset.y() >> joints.back().offset.z();
    } else if (word == "CHANNELS") {
      int count;
      in >> count;
      joints.back().channels.resize(static_cast<std::size_t>(count));
      for (std::string& c : joints.back().channels) in >> c;
    }
  }
  double skip;
  in >> word >> word >> word >> word >> skip;  // Frames: n Frame Time: dt
  std::map<std::string, Vec3> out;
  for (int f = 0; f <= frame; ++f) {
    std::vector<Eigen::Isometry3d> world(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
      Vec3 move = joints[i].offset;
      Mat3 turn = Mat3::Identity();
      for (const std::string& c : joints[i].channels) {
        double v;
        in >> v;
        const int axis = c[0] - 'X';
        if (c.ends_with("position"))
          move[axis] = joints[i].parent < 0 ? v : move[axis] + v;
        else
          turn = turn * Eigen::AngleAxisd(v * M_PI / 180, Vec3::Unit(axis)).toRotationMatrix();
      }
      Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
      local.linear() = turn, local.translation() = move;
      world[i] = joints[i].parent < 0 ? local : world[static_cast<std::size_t>(joints[i].parent)] * local;
      if (f == frame && !joints[i].name.empty()) out[joints[i].name] = world[i].translation();
    }
  }
  return out;
}

TEST(Formats, Bvh_joints_are_where_forward_kinematics_puts_them) {
  for (const char* name : {"cmu_01_playground/01_01.bvh", "animateddrawings_fair1_child/dab.bvh",
                           "animateddrawings_cmu_jacks/jumping_jacks.bvh"}) {
    const auto file = test::assets_root() / "mocap" / name;
    FT_REQUIRE_FILE(file);
    auto loaded = load_character(file, {}, {});
    ASSERT_TRUE(loaded) << loaded.error().text();
    Character& c = loaded->character;
    c.file_unit = 1;
    for (const int frame : {0, 57, 120}) {
      const auto expected = bvh_places(file, frame);
      const double seconds_per_frame = c.clips.at(0).channels.at(0).rotation.times.at(1);
      const auto mine = node_places(c, frame * seconds_per_frame);
      double worst = 0;
      for (const auto& [joint, place] : expected) {
        const auto found = mine.find(joint);
        ASSERT_NE(found, mine.end()) << joint;
        worst = std::max(worst, (found->second - place).norm());
      }
      EXPECT_LT(worst, 2e-4) << name << " frame " << frame << " (file units, of 29 or 47 a body; assimp reads floats)";
    }
  }
}

}  // namespace
}  // namespace ft

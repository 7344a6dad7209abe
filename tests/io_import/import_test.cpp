// import_primary() on real files: units, axes, heights, clips, mesh-less animation, parts; and what bad requests get.
#include "io/import/import.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "baker/core/file.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

std::filesystem::path character(const std::string& name) {
  return test::assets_root() / "characters" / name;
}
std::filesystem::path mocap(const std::string& name) {
  return test::assets_root() / "mocap" / name;
}

bool has_note(const CharacterInfo& info, const std::string& words) {
  return std::any_of(info.notes.begin(), info.notes.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

std::vector<Vec3> bind_positions(const Trajectory& t) {
  std::vector<Vec3> p(static_cast<std::size_t>(t.surface().vertex_count()));
  t.bind_pose(p);
  return p;
}

std::vector<Vec3> positions(const Trajectory& t, double time) {
  std::vector<Vec3> p(static_cast<std::size_t>(t.surface().vertex_count()));
  t.sample(time, p);
  return p;
}

int open_edges(const Surface& surface) {
  std::map<Edge, int> uses;
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
  return static_cast<int>(std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second != 2; }));
}

struct Good {
  const char* file;
  double unit_scale;  // 0: as the file says
  double height;      // m
  int vertices;       // after welding
  bool closed;
};

TEST(Import, Real_characters_arrive_in_metres_and_upright) {
  const Good all[] = {{"cesium_man/cesium_man.gltf", 0, 1.507, 2338, true},
                      {"robot_expressive/RobotExpressive.glb", 1, 4.461, 1820, false},
                      {"quaternius_base_human/human-base-animations.glb", 0, 1.830, 7474, false},
                      {"m2m_horse/horse-animations.glb", 0, 2.035, 1709, true},
                      {"kaykit_mannequin/manny_med_mod.gltf", 0, 2.207, 3417, false},
                      {"ozz_pab_fbx/skeleton.fbx", 0, 1.828, 1415, false},
                      {"mh_adult_cmu_dressed/adult_cmu01.glb", 0, 1.605, 13380, true}};
  for (const Good& good : all) {
    ImportRequest request;
    request.file = character(good.file);
    request.unit_scale = good.unit_scale;
    FT_REQUIRE_FILE(request.file);
    auto primary = import_primary(request);
    ASSERT_TRUE(primary) << primary.error().text();
    const Surface& surface = primary->trajectory->surface();
    const Box box = bounds(bind_positions(*primary->trajectory));
    EXPECT_NEAR(box.size().y(), good.height, 1e-3) << good.file;
    EXPECT_NEAR(box.lo.y(), 0, 0.03) << good.file;
    EXPECT_EQ(surface.vertex_count(), good.vertices) << good.file;
    EXPECT_EQ(open_edges(surface) == 0, good.closed) << good.file;

    ASSERT_GE(surface.parts.size(), 10u) << good.file;
    EXPECT_LE(surface.parts.size(), 40u) << good.file;
    std::vector<int> members(surface.parts.size(), 0);
    for (const int part : surface.part_of_vertex) ++members.at(static_cast<std::size_t>(part));
    for (std::size_t p = 0; p < surface.parts.size(); ++p) {
      EXPECT_GT(members[p], 0) << good.file << " " << surface.parts[p].name;
      EXPECT_GT(surface.parts[p].size, 0);
      int steps = 0;
      for (int up = static_cast<int>(p); up >= 0 && steps < 100;
           up = surface.parts[static_cast<std::size_t>(up)].parent)
        ++steps;
      EXPECT_LT(steps, 100) << "parents form a circle";
    }
    EXPECT_EQ(
        std::count_if(surface.parts.begin(), surface.parts.end(), [](const SurfacePart& p) { return p.parent < 0; }), 1)
        << good.file;
  }
}

TEST(Import, A_hand_is_one_part_and_fingers_belong_to_it) {
  ImportRequest request;
  request.file = character("quaternius_base_human/human-base-animations.glb");
  FT_REQUIRE_FILE(request.file);
  auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  std::map<std::string, std::string> parent;
  const auto& parts = primary->trajectory->surface().parts;
  for (const SurfacePart& p : parts)
    parent[p.name] = p.parent < 0 ? "" : parts[static_cast<std::size_t>(p.parent)].name;
  EXPECT_EQ(parent["DEF-hand.L"], "DEF-forearm.L");
  EXPECT_EQ(parent["DEF-thigh.R"], "DEF-hips");
  for (const auto& [name, above] : parent) EXPECT_EQ(name.find("finger"), std::string::npos) << name;
}

TEST(Import, A_robot_of_four_metres_is_refused_until_its_unit_is_given) {
  ImportRequest request;
  request.file = character("robot_expressive/RobotExpressive.glb");
  FT_REQUIRE_FILE(request.file);
  auto refused = import_primary(request);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("4.461 m tall"), std::string::npos) << refused.error().text();
  EXPECT_NE(refused.error().text().find("unit_scale = 1 keeps it"), std::string::npos) << refused.error().text();
  request.unit_scale = 1;
  EXPECT_TRUE(import_primary(request));
  request.unit_scale = 0, request.height = 1.8;
  auto scaled = import_primary(request);
  ASSERT_TRUE(scaled);
  EXPECT_NEAR(bounds(bind_positions(*scaled->trajectory)).size().y(), 1.8, 1e-9);
}

TEST(Import, A_character_of_175_m_is_told_its_unit) {
  ImportRequest request;
  // The same character from a file in centimetres that does not say so.
  const auto file = character("cesium_man/cesium_man.gltf");
  FT_REQUIRE_FILE(file);
  const test::ScratchFolder scratch;
  std::string text = *read_text(file);
  const auto at = text.find("\"matrix\"");
  ASSERT_NE(at, std::string::npos);
  // First root matrix: a turn to Y-up. A hundredfold scale in its place, still upright.
  const auto open = text.find('[', at), close = text.find(']', at);
  text.replace(open, close - open + 1, "[100,0,0,0, 0,0,-100,0, 0,100,0,0, 0,0,0,1]");
  ASSERT_TRUE(write_text_durably(scratch / "big.gltf", text));
  request.file = scratch / "big.gltf";
  auto refused = import_primary(request);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("150.7 m tall"), std::string::npos) << refused.error().text();
  EXPECT_NE(refused.error().text().find("unit_scale = 0.01 makes it 1.51 m"), std::string::npos)
      << refused.error().text();
  request.unit_scale = 0.01;
  auto accepted = import_primary(request);
  ASSERT_TRUE(accepted) << accepted.error().text();
  EXPECT_NEAR(bounds(bind_positions(*accepted->trajectory)).size().y(), 1.507, 1e-3);
}

TEST(Import, A_clip_with_one_key_and_a_cache_of_one_sample_are_said_to_stand_still) {
  const test::ScratchFolder scratch;
  const auto walker = read_text(std::filesystem::path(FT_SOURCE_DIR) / "tests/data/small_shot/walker.bvh");
  ASSERT_TRUE(walker);
  const std::size_t motion = walker->find("Frames:");
  const std::size_t first = walker->find('\n', walker->find("Frame Time:")) + 1;
  const std::string frame_time = walker->substr(walker->find("Frame Time:"), first - walker->find("Frame Time:"));
  const std::string one_frame = walker->substr(0, motion) + "Frames: 1\n" + frame_time +
                                walker->substr(first, walker->find('\n', first) + 1 - first);
  ASSERT_TRUE(write_text_durably(scratch / "still.bvh", one_frame).ok());
  ASSERT_TRUE(write_text_durably(scratch / "still.obj",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
                  .ok());
  for (const auto& [name, words] : {std::pair{"still.bvh", " has one key only: the character stands still"},
                                    {"still.obj", "is one OBJ and no numbered sequence: it stands still"}}) {
    ImportRequest request;
    request.file = scratch / name;
    for (const double duration : {0.0, 2.0}) {
      request.duration = duration;
      const auto imported = import_primary(request);
      ASSERT_TRUE(imported) << imported.error().text();
      EXPECT_EQ(has_note(imported->info, words), duration > 0) << name;
    }
  }
}

TEST(Import, A_bvh_is_sized_and_turned_by_guess_and_says_so) {
  struct Case {
    const char* file;
    double unit;
    const char* up;
    double least, most;
  };
  for (const Case& c : {Case{"cmu_01_playground/01_01.bvh", 0.05644, "y", 1.5, 1.7},
                        Case{"animateddrawings_cmu_jacks/jumping_jacks.bvh", 0.05644, "y", 1.5, 1.7},
                        Case{"animateddrawings_fair1_child/dab.bvh", 0.0254, "z", 1.1, 1.3}}) {
    ImportRequest request;
    request.file = mocap(c.file);
    request.body = "capsules";
    FT_REQUIRE_FILE(request.file);
    auto primary = import_primary(request);
    ASSERT_TRUE(primary) << primary.error().text();
    EXPECT_EQ(primary->info.unit_scale, c.unit) << c.file;
    EXPECT_EQ(primary->info.up, c.up) << c.file;
    EXPECT_TRUE(has_note(primary->info, "unit guessed")) << c.file;
    EXPECT_TRUE(has_note(primary->info, "up axis guessed")) << c.file;
    const Box box = bounds(positions(*primary->trajectory, 0));
    EXPECT_GT(box.size().y(), c.least) << c.file;
    EXPECT_LT(box.size().y(), c.most) << c.file;
    EXPECT_NEAR(box.lo.y(), 0, 0.06) << c.file << ": mocap stands on the floor";

    request.unit_scale = 2 * c.unit, request.up = c.up;
    auto twice = import_primary(request);
    ASSERT_TRUE(twice) << twice.error().text();
    EXPECT_FALSE(has_note(twice->info, "guessed"));
    EXPECT_NEAR(bounds(positions(*twice->trajectory, 0)).size().y(), 2 * box.size().y(), 1e-9);
  }
}

TEST(Import, An_up_axis_that_is_given_turns_the_character) {
  ImportRequest request;
  request.file = character("cesium_man/cesium_man.gltf");
  FT_REQUIRE_FILE(request.file);
  auto as_is = import_primary(request);
  ASSERT_TRUE(as_is);
  request.up = "z", request.unit_scale = 1;
  auto turned = import_primary(request);
  ASSERT_TRUE(turned) << turned.error().text();
  const auto a = bind_positions(*as_is->trajectory), b = bind_positions(*turned->trajectory);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT((b[i] - Vec3(a[i].x(), a[i].z(), -a[i].y())).norm(), 1e-12);
  request.up = "w";
  EXPECT_EQ(exit_code(import_primary(request).error().kind), 2);
}

TEST(Import, A_clip_that_does_not_exist_is_answered_with_those_that_do) {
  ImportRequest request;
  request.file = character("robot_expressive/RobotExpressive.glb");
  FT_REQUIRE_FILE(request.file);
  request.unit_scale = 1;
  request.clip = "Wlaking";
  auto primary = import_primary(request);
  ASSERT_FALSE(primary);
  EXPECT_EQ(exit_code(primary.error().kind), 2);
  const std::string text = primary.error().text();
  EXPECT_NE(text.find("did you mean \"Walking\""), std::string::npos) << text;
  for (const char* name : {"Dance", "ThumbsUp", "WalkJump", "Yes"})
    EXPECT_NE(text.find(name), std::string::npos) << text;
  request.clip.clear();
  primary = import_primary(request);
  ASSERT_TRUE(primary);
  EXPECT_TRUE(has_note(primary->info, "14 clips and none was asked for; \"Dance\" is taken"));
}

TEST(Import, A_shot_that_leaves_the_clip_is_refused_with_the_clips_length) {
  ImportRequest request;
  request.file = character("cesium_man/cesium_man.gltf");
  FT_REQUIRE_FILE(request.file);
  request.shot_fps = 24;
  request.duration = 2 + 1 / 24.0;  // one frame over is held
  EXPECT_TRUE(import_primary(request));
  request.duration = 2 + 1.1 / 24.0;
  auto refused = import_primary(request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(exit_code(refused.error().kind), 2);
  EXPECT_NE(refused.error().text().find("2.000 s long (49 frames of this shot)"), std::string::npos)
      << refused.error().text();
  request.duration = 1, request.speed = 2.1;
  EXPECT_FALSE(import_primary(request));
  request.speed = 0.5, request.clip_start = 1.4;
  EXPECT_TRUE(import_primary(request));
  request.clip_start = 1.6;
  EXPECT_FALSE(import_primary(request));
}

TEST(Import, A_first_key_that_is_not_at_0_is_where_the_clip_starts) {
  ImportRequest request;
  request.file = character("m2m_horse/horse-animations.glb");
  FT_REQUIRE_FILE(request.file);
  request.clip = "Run";
  auto primary = import_primary(request);
  ASSERT_TRUE(primary);
  const auto run = std::find_if(primary->info.clips.begin(), primary->info.clips.end(),
                                [](const ClipInfo& c) { return c.name == "Run"; });
  ASSERT_NE(run, primary->info.clips.end());
  EXPECT_NEAR(run->start, 1.0 / 30, 1e-6);
  const auto a = positions(*primary->trajectory, 0), b = positions(*primary->trajectory, 0.02);
  double moved = 0;
  for (std::size_t i = 0; i < a.size(); ++i) moved = std::max(moved, (a[i] - b[i]).norm());
  EXPECT_GT(moved, 1e-3) << "the horse waits for its first key";
}

TEST(Import, An_animation_without_a_mesh_moves_the_character_of_another_file) {
  ImportRequest request;
  request.file = character("kaykit_mannequin/manny_med_mod.gltf");
  request.animation = character("kaykit_mannequin/Med_MovementBasic.glb");
  FT_REQUIRE_FILE(request.file);
  request.clip = "Rig_Medium|Running_A";
  auto run = import_primary(request);
  ASSERT_TRUE(run) << run.error().text();
  EXPECT_NEAR(run->info.clips.at(5).start, 1.0 / 30, 1e-6);
  EXPECT_NEAR(run->info.clips.at(5).duration, 0.8, 1e-6);
  EXPECT_TRUE(has_note(run->info, "2 animated nodes are not in the character: handslot.l, handslot.r"));
  const auto a = positions(*run->trajectory, 0), b = positions(*run->trajectory, 0.2);
  double moved = 0;
  for (std::size_t i = 0; i < a.size(); ++i) moved = std::max(moved, (a[i] - b[i]).norm());
  EXPECT_GT(moved, 0.2);
  EXPECT_LT(moved, 1.5);
  EXPECT_LT((bounds(a).size() - bounds(b).size()).norm(), 1);

  ImportRequest alone;
  alone.file = request.animation;
  auto refused = import_primary(alone);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("animation ="), std::string::npos) << refused.error().text();

  request.animation = character("cesium_man/cesium_man.gltf");
  request.clip.clear();
  refused = import_primary(request);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("no name is in both"), std::string::npos) << refused.error().text();
}

TEST(Import, An_fbx_runner_in_centimetres_stands_on_the_floor_and_runs_forward) {
  ImportRequest request;
  request.file = character("ozz_pab_fbx/skeleton.fbx");
  request.animation = character("ozz_pab_fbx/run.fbx");
  FT_REQUIRE_FILE(request.file);
  request.duration = 0.6;
  auto run = import_primary(request);
  ASSERT_TRUE(run) << run.error().text();
  EXPECT_NEAR(run->info.unit_scale, 0.01, 1e-12);
  double lowest = 1e9;
  for (double t = 0; t <= 0.65; t += 0.02) {
    const Box box = bounds(positions(*run->trajectory, t));
    lowest = std::min(lowest, box.lo.y());
    EXPECT_GT(box.hi.y(), 1.5) << t;
    EXPECT_LT(box.hi.y(), 1.9) << "twice the height: pivots are counted twice";
  }
  EXPECT_NEAR(lowest, 0, 0.06);
  const Vec3 start = bounds(positions(*run->trajectory, 0)).lo, end = bounds(positions(*run->trajectory, 0.6)).lo;
  EXPECT_GT((end - start).norm(), 1.5) << "root motion is lost";
}

TEST(Import, A_mesh_that_does_not_exist_is_answered_with_those_that_do) {
  ImportRequest request;
  request.file = character("robot_expressive/RobotExpressive.glb");
  FT_REQUIRE_FILE(request.file);
  request.unit_scale = 1;
  request.meshes = {"Torso", "Haed"};
  auto refused = import_primary(request);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("did you mean \"Head\""), std::string::npos) << refused.error().text();
  request.meshes = {"Torso", "Head"};
  auto some = import_primary(request);
  ASSERT_TRUE(some);
  EXPECT_LT(some->info.vertex_count, 7214);
}

TEST(Import, Nonsense_in_the_request_is_a_usage_error) {
  const auto code = [](auto change) {
    ImportRequest request;
    request.file = "a.glb";
    change(request);
    const auto result = import_primary(request);
    return result ? 0 : exit_code(result.error().kind);
  };
  EXPECT_EQ(code([](ImportRequest& r) { r.body = "jelly"; }), 2);
  EXPECT_EQ(code([](ImportRequest& r) { r.speed = 0; }), 2);
  EXPECT_EQ(code([](ImportRequest& r) { r.speed = std::nan(""); }), 2);
  EXPECT_EQ(code([](ImportRequest& r) { r.shot_fps = -1; }), 2);
  EXPECT_EQ(code([](ImportRequest& r) { r.preroll = std::nan(""); }), 2);
  EXPECT_EQ(code([](ImportRequest& r) { r.clip_start = 1 / 0.0; }), 2);
  EXPECT_EQ(code([](ImportRequest&) {}), 3);
}

TEST(Inspect, Tells_what_is_in_a_file_without_refusing_its_size) {
  FT_REQUIRE_FILE(character("robot_expressive/RobotExpressive.glb"));
  auto robot = inspect_character(character("robot_expressive/RobotExpressive.glb"));
  ASSERT_TRUE(robot) << robot.error().text();
  EXPECT_EQ(robot->format, "glTF");
  EXPECT_EQ(robot->clips.size(), 14u);
  EXPECT_EQ(robot->vertex_count, 7214);
  EXPECT_EQ(robot->triangle_count, 3237);
  EXPECT_NEAR(robot->bind_bounds.size().y(), 4.461, 1e-3);
  EXPECT_TRUE(has_note(*robot, "weights normalised (sums 1..1.755)"));
  auto motion = inspect_character(character("kaykit_mannequin/Med_Simulation.glb"));
  ASSERT_TRUE(motion) << motion.error().text();
  EXPECT_TRUE(has_note(*motion, "no mesh"));
  EXPECT_FALSE(motion->clips.empty());
}

}  // namespace
}  // namespace ft

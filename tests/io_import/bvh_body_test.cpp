// Bodies around skeletons of motion capture, whatever their joints are called and however they rest: whole, closed, of
// a figure's size, with limbs where limbs are. And the T-pose that a shot can ask for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "baker/core/file.h"
#include "baker/core/mesh.h"
#include "io/import/body/figure.h"
#include "io/import/import.h"
#include "io/import/motion/placed_character.h"
#include "tests/io_import/figure_bvh.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

using test::FigureKind;
using test::FigureRest;

constexpr test::FigureNames k_cmu = {
    "Hips",        "LowerBack", "Spine",         "Neck",       "Head",         "LeftShoulder", "LeftArm",
    "LeftForeArm", "LeftHand",  "RightShoulder", "RightArm",   "RightForeArm", "RightHand",    "LeftUpLeg",
    "LeftLeg",     "LeftFoot",  "LeftToeBase",   "RightUpLeg", "RightLeg",     "RightFoot",    "RightToeBase"};
constexpr test::FigureNames k_mixamo = {"mixamorig:Hips",          "mixamorig:Spine",       "mixamorig:Spine1",
                                        "mixamorig:Neck",          "mixamorig:Head",        "mixamorig:LeftShoulder",
                                        "mixamorig:LeftArm",       "mixamorig:LeftForeArm", "mixamorig:LeftHand",
                                        "mixamorig:RightShoulder", "mixamorig:RightArm",    "mixamorig:RightForeArm",
                                        "mixamorig:RightHand",     "mixamorig:LeftUpLeg",   "mixamorig:LeftLeg",
                                        "mixamorig:LeftFoot",      "mixamorig:LeftToeBase", "mixamorig:RightUpLeg",
                                        "mixamorig:RightLeg",      "mixamorig:RightFoot",   "mixamorig:RightToeBase"};
constexpr test::FigureNames k_bandai = {
    "Hips",       "Spine",  "Chest",      "Neck",       "Head",       "Shoulder_L", "UpperArm_L",
    "LowerArm_L", "Hand_L", "Shoulder_R", "UpperArm_R", "LowerArm_R", "Hand_R",     "UpperLeg_L",
    "LowerLeg_L", "Foot_L", "Toes_L",     "UpperLeg_R", "LowerLeg_R", "Foot_R",     "Toes_R"};
constexpr test::FigureNames k_biovision = {
    "Hips",      "Chest",     "Chest2",      "Neck",          "Head",       "LeftCollar", "LeftShoulder",
    "LeftElbow", "LeftWrist", "RightCollar", "RightShoulder", "RightElbow", "RightWrist", "LeftHip",
    "LeftKnee",  "LeftAnkle", "LeftToe",     "RightHip",      "RightKnee",  "RightAnkle", "RightToe"};
constexpr test::FigureNames k_truebones = {
    "Bip01 Pelvis",     "Bip01 Spine",     "Bip01 Spine1", "Bip01 Neck",       "Bip01 Head",       "Bip01 L Clavicle",
    "Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand", "Bip01 R Clavicle", "Bip01 R UpperArm", "Bip01 R Forearm",
    "Bip01 R Hand",     "Bip01 L Thigh",   "Bip01 L Calf", "Bip01 L Foot",     "Bip01 L Toe0",     "Bip01 R Thigh",
    "Bip01 R Calf",     "Bip01 R Foot",    "Bip01 R Toe0"};
constexpr test::FigureNames k_smpl = {"Pelvis",     "Spine1",  "Spine3",  "Neck",     "Head",       "L_Collar",
                                      "L_Shoulder", "L_Elbow", "L_Wrist", "R_Collar", "R_Shoulder", "R_Elbow",
                                      "R_Wrist",    "L_Hip",   "L_Knee",  "L_Ankle",  "L_Foot",     "R_Hip",
                                      "R_Knee",     "R_Ankle", "R_Foot"};
constexpr test::FigureNames k_asf = {"root",     "lowerback", "thorax", "lowerneck", "head",     "lclavicle",
                                     "lhumerus", "lradius",   "lwrist", "rclavicle", "rhumerus", "rradius",
                                     "rwrist",   "lfemur",    "ltibia", "lfoot",     "ltoes",    "rfemur",
                                     "rtibia",   "rfoot",     "rtoes"};
constexpr test::FigureNames k_xsens = {
    "Hips",          "L5",           "T8",           "Neck",          "Head",          "LeftShoulder",
    "LeftUpperArm",  "LeftForeArm",  "LeftHand",     "RightShoulder", "RightUpperArm", "RightForeArm",
    "RightHand",     "LeftUpperLeg", "LeftLowerLeg", "LeftFoot",      "LeftToe",       "RightUpperLeg",
    "RightLowerLeg", "RightFoot",    "RightToe"};
constexpr test::FigureNames k_sideless = {"Hips",    "Spine", "Chest",  "Neck",  "Head",    "Collar", "Arm",
                                          "ForeArm", "Hand",  "Collar", "Arm",   "ForeArm", "Hand",   "UpLeg",
                                          "Leg",     "Foot",  "Toe",    "UpLeg", "Leg",     "Foot",   "Toe"};
constexpr test::FigureNames k_unknown = {"b0",  "b1",  "b2",  "b3",  "b4",  "b5",  "b6",  "b7",  "b8",  "b9", "b10",
                                         "b11", "b12", "b13", "b14", "b15", "b16", "b17", "b18", "b19", "b20"};

struct Body {
  PlacedCharacter placed;
  std::unique_ptr<Trajectory> trajectory;
  CharacterInfo info;
  std::vector<Vec3> bind;
  std::vector<Triangle> triangles;
  Vec3 joint(int node) const { return (placed.placement * placed.bind.globals[at(node)]).topRightCorner<3, 1>(); }
};

Body import_body(const ImportRequest& request) {
  Body out;
  auto placed = place_character(request);
  EXPECT_TRUE(placed) << placed.error().text();
  if (!placed) return out;
  out.placed = *placed;
  auto played = play(std::move(*placed), request);
  EXPECT_TRUE(played) << played.error().text();
  if (!played) return out;
  out.trajectory = std::move(played->trajectory), out.info = std::move(played->info);
  out.triangles = out.trajectory->surface().triangles;
  out.bind.resize(at(out.trajectory->surface().vertex_count()));
  out.trajectory->bind_pose(out.bind);
  return out;
}

Body import_text(const std::string& text, ImportRequest request = {}) {
  const test::ScratchFolder scratch;
  request.file = scratch / "figure.bvh";
  EXPECT_TRUE(write_text_durably(request.file, text));
  return import_body(request);
}

bool has_note(const CharacterInfo& info, const std::string& words) {
  return std::any_of(info.notes.begin(), info.notes.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

bool is_closed(const std::vector<Triangle>& triangles) {
  std::map<std::array<int, 2>, int> uses;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  return !uses.empty() && std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    return use.second == 1 && uses.count({use.first[1], use.first[0]}) == 1;
  });
}

int piece_count(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
  std::vector<int> top(vertex_count);
  for (std::size_t v = 0; v < vertex_count; ++v) top[v] = static_cast<int>(v);
  const auto find = [&](int v) {
    while (top[at(v)] != v) v = top[at(v)] = top[at(top[at(v)])];
    return v;
  };
  for (const Triangle& t : triangles) top[at(find(t[0]))] = find(t[1]), top[at(find(t[1]))] = find(t[2]);
  int out = 0;
  for (std::size_t v = 0; v < vertex_count; ++v) out += find(static_cast<int>(v)) == static_cast<int>(v);
  return out;
}

/// Longest edge in `now`, as a multiple of what it is in the bind pose or of a centimetre, whichever is more.
double most_torn(const Body& body, const std::vector<Vec3>& now) {
  double out = 0;
  for (const Triangle& t : body.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = at(t[k]), b = at(t[(k + 1) % 3]);
      out = std::max(out, (now[a] - now[b]).norm() / std::max(0.01, (body.bind[a] - body.bind[b]).norm()));
    }
  return out;
}

double nearest(const std::vector<Vec3>& points, const Vec3& p) {
  double out = 1e300;
  for (const Vec3& q : points) out = std::min(out, (p - q).norm());
  return out;
}

struct Convention {
  const char* name;
  FigureKind kind;
  double unit;
  bool made;  ///< the body is built in a T-pose that was made
};

std::vector<Convention> conventions() {
  using R = FigureRest;
  return {{"CMU in its own unit", {k_cmu, R::k_a_pose, 1 / 0.05644, false, nullptr, 0.09}, 0.05644, false},
          {"CMU, T", {k_cmu, R::k_t_pose, 100, false, nullptr, 0.09}, 0.01, false},
          {"LaFAN1", {k_cmu, R::k_bones_on_x, 100, false, nullptr, 0.09}, 0.01, true},
          {"Rokoko, narrow hips", {k_cmu, R::k_bones_on_x, 100, false, nullptr, 0.07}, 0.01, true},
          {"mirrored", {k_cmu, R::k_mirrored_x, 100, false, nullptr, 0.09}, 0.01, true},
          {"Mixamo", {k_mixamo, R::k_t_pose, 100, false, nullptr, 0.09}, 0.01, false},
          {"Mixamo, folded", {k_mixamo, R::k_bones_on_x, 1, false, nullptr, 0.09}, 1, true},
          {"Bandai Namco", {k_bandai, R::k_t_pose, 100, false, "joint_Root", 0.09}, 0.01, false},
          {"Bandai Namco, folded", {k_bandai, R::k_bones_on_x, 100, false, "joint_Root", 0.09}, 0.01, true},
          {"Truebones", {k_truebones, R::k_arms_down, 1 / 0.0254, false, "Bip01", 0.09}, 0.0254, false},
          {"Truebones, folded", {k_truebones, R::k_bones_on_x, 100, true, nullptr, 0.09}, 0.01, true},
          {"Biovision", {k_biovision, R::k_arms_down, 100, false, nullptr, 0.09}, 0.01, false},
          {"SMPL, metres, Z up", {k_smpl, R::k_t_pose, 1, true, nullptr, 0.09}, 1, false},
          {"ASF", {k_asf, R::k_a_pose, 1000, false, nullptr, 0.09}, 0.001, false},
          {"Xsens", {k_xsens, R::k_t_pose, 100, false, "Reference", 0.09}, 0.01, false},
          {"no sides", {k_sideless, R::k_bones_on_x, 100, false, nullptr, 0.09}, 0.01, true}};
}

TEST(BvhBody, Every_convention_gives_a_whole_figure_of_its_size_slow) {
  for (const Convention& c : conventions()) {
    SCOPED_TRACE(c.name);
    const Body body = import_text(test::figure_bvh(c.kind));
    if (!body.trajectory) continue;
    EXPECT_EQ(body.info.unit_scale, c.unit);
    EXPECT_EQ(body.info.up, c.kind.z_up ? "z" : "y");
    EXPECT_EQ(has_note(body.info, "T-pose made from the skeleton"), c.made);
    EXPECT_TRUE(is_closed(body.triangles));
    EXPECT_EQ(piece_count(body.triangles, body.bind.size()), 1);
    const Vec3 size = bounds(body.bind).size();
    EXPECT_NEAR(size.y(), 1.79, 0.05);
    EXPECT_NEAR(size.x(), 1.77, 0.06);  // arms to the sides
    EXPECT_LT(size.z(), 0.42);
    // Flesh is where a T-pose has it: within a hand's breadth of each joint, and nowhere else.
    const auto expected = test::figure_t_pose(c.kind.hips);
    for (int j = 0; j < test::k_figure_joints; ++j)
      EXPECT_LT(nearest(body.bind, expected[at(j)]), 0.13) << "joint " << c.kind.names[at(j)];
    const Figure figure = find_figure(body.placed.character);
    ASSERT_TRUE(figure.missing().empty());
    const int left = c.kind.names[6] == std::string("Arm") ? 0 : figure.arms[0].side == Side::k_left ? 0 : 1;
    EXPECT_GT(body.joint(figure.arms[at(left)].end).x(), 0.6) << "the left hand is to the left, facing z";
    EXPECT_NEAR(body.joint(figure.legs[at(left)].end).y(), 0.06, 0.03);
    // The motion moves it as one: no sheets between limbs, no more than skin stretches at a joint.
    std::vector<Vec3> now(body.bind.size());
    for (const double time : {0.0, 0.13, 0.33}) {
      body.trajectory->sample(time, now);
      EXPECT_LT(most_torn(body, now), 6) << "at " << time;
      EXPECT_NEAR(bounds(now).size().y(), 1.77, 0.08);
    }
  }
}

TEST(BvhBody, The_same_motion_is_the_same_whatever_the_rest_pose_slow) {
  const auto joints_at = [](const Body& body, double time) {
    std::vector<Vec3> now(body.bind.size());
    body.trajectory->sample(time, now);
    return bounds(now);
  };
  const Body plain = import_text(test::figure_bvh({k_cmu}));
  for (const FigureRest rest : {FigureRest::k_a_pose, FigureRest::k_bones_on_x, FigureRest::k_mirrored_x}) {
    const Body other = import_text(test::figure_bvh({k_cmu, rest}));
    ASSERT_TRUE(plain.trajectory && other.trajectory);
    for (const double time : {0.0, 0.2}) {
      const Box a = joints_at(plain, time), b = joints_at(other, time);
      EXPECT_LT((a.lo - b.lo).norm() + (a.hi - b.hi).norm(), 0.08) << static_cast<int>(rest);  // twist and toes differ
    }
  }
}

TEST(BvhBody, Rokokos_figure_is_whole_slow) {
  ImportRequest request;
  request.file = test::assets_root() / "faults_cloth/rokoko_body/jesse60.bvh";
  FT_REQUIRE_FILE(request.file);
  request.duration = 9.0 / 25, request.shot_fps = 25;
  for (const double height : {0.0, 1.75}) {
    request.height = height;
    const Body body = import_body(request);
    ASSERT_TRUE(body.trajectory);
    EXPECT_TRUE(is_closed(body.triangles));
    EXPECT_EQ(piece_count(body.triangles, body.bind.size()), 1);
    EXPECT_NEAR(bounds(body.bind).size().y(), height > 0 ? height : 1.8, height > 0 ? 1e-9 : 0.1);
    EXPECT_TRUE(has_note(body.info, "unit guessed from the skeleton's height: centimetres"));
    std::vector<Vec3> now(body.bind.size());
    for (const double time : {0.0, 0.2, 0.36}) {
      body.trajectory->sample(time, now);
      EXPECT_LT(bounds(now).size().norm(), 2.3);
      EXPECT_LT(most_torn(body, now), 6);
    }
  }
}

TEST(BvhBody, Two_figures_in_a_file_get_two_bodies) {
  const std::string one = test::figure_bvh({k_cmu}, 1);
  const std::size_t tree = one.find("ROOT"), motion = one.find("MOTION"), numbers = one.find("0.0333333\n") + 10;
  std::string numbers_text = one.substr(numbers, one.size() - numbers - 1);
  const std::string text = one.substr(0, motion) + one.substr(tree, motion - tree) +
                           one.substr(motion, numbers - motion) + numbers_text + " " + numbers_text + "\n";
  const Body body = import_text(text);
  ASSERT_TRUE(body.trajectory);
  EXPECT_EQ(body.info.mesh_names, (std::vector<std::string>{"body_1", "body_2"}));
  EXPECT_TRUE(is_closed(body.triangles));
}

TEST(BvhBody, Unknown_names_that_rest_folded_take_the_first_pose_of_the_motion) {
  const Body body = import_text(test::figure_bvh({k_unknown, FigureRest::k_bones_on_x}));
  ASSERT_TRUE(body.trajectory);
  EXPECT_TRUE(has_note(body.info, "names are not known"));
  EXPECT_EQ(body.info.unit_scale, 0.01);
  EXPECT_TRUE(is_closed(body.triangles));
  EXPECT_EQ(piece_count(body.triangles, body.bind.size()), 1);
  EXPECT_NEAR(bounds(body.bind).size().y(), 1.83, 0.1);  // the flesh of unnamed bones goes on beyond their ends
}

TEST(BvhBody, A_motion_of_another_size_than_its_skeleton_is_refused_with_numbers) {
  std::string text = test::figure_bvh({k_cmu});
  // All joints below the root get positions that grow away from their OFFSETs in the course of the clip.
  const std::string channels = "CHANNELS 3 Zrotation";
  for (std::size_t found = text.find(channels); found != std::string::npos; found = text.find(channels, found + 8))
    text.replace(found, channels.size(), "CHANNELS 6 Xposition Yposition Zposition Zrotation");
  const auto t_pose = test::figure_t_pose();
  std::string head = text.substr(0, text.find("MOTION"));
  head += "MOTION\nFrames: 3\nFrame Time: 0.04\n";
  const int parents[] = {-1, 0, 1, 2, 3, 2, 5, 6, 7, 2, 9, 10, 11, 0, 13, 14, 15, 0, 17, 18, 19};
  for (const double grown : {1.0, 1.0, 20.0}) {
    head += "0 95 0 0 0 0";
    for (std::size_t j = 1; j < t_pose.size(); ++j) {
      const Vec3 o = 100 * grown * (t_pose[j] - t_pose[at(parents[j])]);
      for (int k = 0; k < 3; ++k) head.append(" ").append(std::to_string(o[k]));
      head += " 0 0 0";
    }
    head += "\n";
  }
  const test::ScratchFolder scratch;
  ImportRequest request;
  request.file = scratch / "grows.bvh", request.duration = 0.08, request.shot_fps = 25, request.height = 1.75;
  ASSERT_TRUE(write_text_durably(request.file, head));
  const auto refused = import_primary(request);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("m from corner to corner"), std::string::npos) << refused.error().text();
}

/// Arms level to the sides, legs straight down.
void expect_t_pose(const Body& body) {
  const Figure figure = find_figure(body.placed.character);
  ASSERT_TRUE(figure.missing().empty());
  for (const FigureLimb& arm : figure.arms) {
    const Vec3 upper = (body.joint(arm.lower) - body.joint(arm.upper)).normalized(),
               lower = (body.joint(arm.end) - body.joint(arm.lower)).normalized();
    EXPECT_NEAR(upper.y(), 0, 1e-6);
    EXPECT_NEAR(lower.y(), 0, 1e-6);
    EXPECT_GT(std::abs(upper.x()), 0.98);
    EXPECT_NEAR(upper.dot(lower), 1, 1e-9);
  }
  for (const FigureLimb& leg : figure.legs) {
    EXPECT_NEAR((body.joint(leg.lower) - body.joint(leg.upper)).normalized().y(), -1, 1e-9);
    EXPECT_NEAR((body.joint(leg.end) - body.joint(leg.lower)).normalized().y(), -1, 1e-9);
  }
}

TEST(TPose, Of_motion_capture_has_level_arms_and_straight_legs) {
  ImportRequest request;
  request.bind = "t_pose", request.body = "capsules";
  for (const FigureKind& kind :
       {FigureKind{k_cmu, FigureRest::k_a_pose}, FigureKind{k_truebones, FigureRest::k_arms_down},
        FigureKind{k_bandai, FigureRest::k_bones_on_x}, FigureKind{k_smpl, FigureRest::k_t_pose, 1, true}}) {
    const Body body = import_text(test::figure_bvh(kind), request);
    ASSERT_TRUE(body.trajectory);
    EXPECT_TRUE(has_note(body.info, "bind = \"t_pose\""));
    expect_t_pose(body);
  }
}

TEST(TPose, Of_skinned_characters_leaves_bones_as_long_and_soles_as_level_as_they_are) {
  const auto characters = test::assets_root() / "characters";
  int seen = 0;
  for (const char* name : {"quaternius_base_human/human-base-animations.glb", "m2m_human_addon/human-addon.glb",
                           "mh_adult_cmu_dressed/adult_cmu01.glb", "ozz_pab_fbx/skeleton.fbx"}) {
    if (!std::filesystem::exists(characters / name)) continue;
    ++seen;
    SCOPED_TRACE(name);
    ImportRequest request;
    request.file = characters / name;
    const Body as_is = import_body(request);
    request.bind = "t_pose";
    const Body body = import_body(request);
    ASSERT_TRUE(body.trajectory && as_is.trajectory);
    expect_t_pose(body);
    const auto& nodes = body.placed.character.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].parent < 0) continue;
      const auto bone = [&](const Body& b) { return (b.joint(static_cast<int>(i)) - b.joint(nodes[i].parent)).norm(); };
      EXPECT_NEAR(bone(body), bone(as_is), 1e-9) << nodes[i].name;
    }
    EXPECT_NEAR(bounds(body.bind).size().y(), bounds(as_is.bind).size().y(), 0.05);
    EXPECT_LT(most_torn(body, as_is.bind), 5);
    for (const double time : {0.0, 0.4}) {  // the motion is what it is
      std::vector<Vec3> p(body.bind.size()), q = p;
      body.trajectory->sample(time, p), as_is.trajectory->sample(time, q);
      EXPECT_EQ(p, q);
    }
  }
  if (seen == 0) GTEST_SKIP() << "skipped: characters not present";
}

TEST(TPose, Joints_that_are_not_found_are_named) {
  const test::ScratchFolder scratch;
  ImportRequest request;
  request.file = scratch / "figure.bvh", request.bind = "t_pose";
  test::FigureNames names = k_cmu;
  names[8] = "paw", names[14] = "strut";
  ASSERT_TRUE(write_text_durably(request.file, test::figure_bvh({names})));
  const auto refused = import_primary(request);
  ASSERT_FALSE(refused);
  for (const char* words : {"t_pose", "the hand of the left arm", "the knee of the left leg"})
    EXPECT_NE(refused.error().text().find(words), std::string::npos) << refused.error().text();
  EXPECT_EQ(refused.error().text().find("right"), std::string::npos) << refused.error().text();
  request.bind = "a_pose";
  EXPECT_FALSE(import_primary(request));
  request.bind = "t_pose", request.file = scratch / "cache.obj";
  ASSERT_TRUE(write_text_durably(request.file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  const auto cache = import_primary(request);
  ASSERT_FALSE(cache);
  EXPECT_NE(cache.error().text().find("needs a skeleton"), std::string::npos) << cache.error().text();
}

TEST(JointNames, Are_known_in_the_usual_conventions) {
  for (const test::FigureNames* names :
       {&k_cmu, &k_mixamo, &k_bandai, &k_biovision, &k_truebones, &k_smpl, &k_asf, &k_xsens}) {
    for (std::size_t j = 5; j < names->size(); ++j) {
      const bool left = j < 9 || (j >= 13 && j < 17);
      EXPECT_EQ(side_by_name((*names)[j]), left ? Side::k_left : Side::k_right) << (*names)[j];
    }
    for (std::size_t j = 0; j < 5; ++j) EXPECT_EQ(side_by_name((*names)[j]), Side::k_none) << (*names)[j];
    for (const std::size_t foot : {15, 19}) EXPECT_EQ(limb_by_name((*names)[foot]), Limb::k_foot);
    for (const std::size_t arm : {7, 11}) EXPECT_EQ(limb_by_name((*names)[arm]), Limb::k_forearm);
  }
  EXPECT_EQ(limb_by_name("Armature"), Limb::k_other);
  EXPECT_EQ(limb_by_name("upper_arm.L"), Limb::k_upper_arm);
  EXPECT_EQ(limb_by_name("Left upper leg"), Limb::k_thigh);
  EXPECT_EQ(side_by_name("J_Bip_R_UpperLeg"), Side::k_right);
  EXPECT_EQ(side_by_name("Alright:Head"), Side::k_none);
  EXPECT_EQ(side_by_name("rHumerus"), Side::k_right);
  EXPECT_EQ(side_by_name("root"), Side::k_none);
}

}  // namespace
}  // namespace ft

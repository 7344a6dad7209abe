// FBX animation: small files written here as text, and the folders of faults.
#include "io/import/fbx/fbx_clips.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "io/import/character/pose.h"
#include "io/import/fbx/fbx_curves.h"
#include "io/import/fbx/fbx_transform.h"
#include "tests/io_import/faults.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

constexpr long k_second = 46186158000;

/// Text of an FBX file with one joint (id 1), a take of `stop` seconds and layers (ids 20, 21, ...), each of which
/// moves a property of the joint by the curve (ids 40, 41, ...) that is given.
struct Layer {
  std::string settings, property, curve;
};

std::string property(const char* name, double x, double y, double z) {
  char text[200];
  std::snprintf(text, sizeof text, "P: \"%s\", \"Vector3D\", \"Vector\", \"\",%.9g,%.9g,%.9g\n", name, x, y, z);
  return text;
}

std::string curve(const std::string& times, const std::string& values, const std::string& flags,
                  const std::string& data, const std::string& runs, const std::string& more = {}) {
  const auto list = [](const char* name, const std::string& numbers) {
    const auto count = std::count(numbers.begin(), numbers.end(), ',') + 1;
    return std::string(name) + ": *" + std::to_string(count) + " {\na: " + numbers + "\n}\n";
  };
  return list("KeyTime", times) + list("KeyValueFloat", values) + list("KeyAttrFlags", flags) +
         list("KeyAttrDataFloat", data) + list("KeyAttrRefCount", runs) + more;
}

std::string fbx(const std::string& joint, double stop, const std::vector<Layer>& layers, const std::string& more = {},
                const std::string& connections = {}) {
  std::string objects = "Model: 1, \"Model::joint\", \"LimbNode\" {\nProperties70: {\n" + joint + "}\n}\n" + more;
  objects +=
      "AnimationStack: 10, \"AnimStack::take\", \"\" {\nProperties70: {\nP: \"LocalStop\", \"KTime\", \"Time\", \"\"," +
      std::to_string(std::llround(stop * k_second)) + "\n}\n}\n";
  std::string links = "C: \"OO\",1,0\n" + connections;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const auto id = [&](int base) { return std::to_string(base + static_cast<int>(l)); };
    objects += "AnimationLayer: " + id(20) + ", \"AnimLayer::layer\", \"\" {\nProperties70: {\n" + layers[l].settings +
               "}\n}\n";
    objects += "AnimationCurveNode: " + id(30) +
               ", \"AnimCurveNode::R\", \"\" {\nProperties70: {\nP: \"d|X\", \"Number\", \"\", \"A\",0\nP: \"d|Y\", "
               "\"Number\", \"\", \"A\",5\nP: \"d|Z\", \"Number\", \"\", \"A\",0\n}\n}\n";
    objects += "AnimationCurve: " + id(40) + ", \"AnimCurve::\", \"\" {\n" + layers[l].curve + "}\n";
    links += "C: \"OO\"," + id(20) + ",10\nC: \"OO\"," + id(30) + "," + id(20) + "\nC: \"OP\"," + id(30) + ",1, \"" +
             layers[l].property + "\"\nC: \"OP\"," + id(40) + "," + id(30) + ", \"d|X\"\n";
  }
  return "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}\nObjects: {\n" +
         objects + "}\nConnections: {\n" + links + "}\n";
}

struct Read {
  Character character;
  std::vector<Mat4> at(double time) const {
    const ClipPose pose(character, character.clips.empty() ? nullptr : &character.clips[0]);
    std::vector<Mat4> locals(character.nodes.size());
    std::vector<double> morphs(pose.rest_morphs().size());
    pose.sample(time, locals, morphs);
    return locals;
  }
};

Read read(const std::string& text, std::vector<FbxShapeChannel> shapes = {}) {
  Read out;
  auto document = FbxDocument::read(std::as_bytes(std::span(text.data(), text.size())));
  EXPECT_TRUE(document) << document.error().text();
  if (!document) return out;
  const std::vector<const FbxObject*> models{document->object(1)};
  const std::vector<int> parents{-1};
  std::vector<Mat4> locals(1, Mat4::Identity());
  fbx_rest_locals(models, parents, locals);
  out.character.nodes.push_back({"joint", -1, locals[0], {0, 0}});
  read_fbx_clips(*document, models, shapes, out.character);
  EXPECT_TRUE(check_character(out.character));
  return out;
}

double place(const Read& r, double time) {
  return r.at(time)[0](0, 3);
}

std::string bits(double value) {
  return std::to_string(std::bit_cast<std::int32_t>(static_cast<float>(value)));
}

const std::string k_two_keys = "0," + std::to_string(k_second);

TEST(FbxCurve, Cubic_keys_with_tangents_of_the_file_linear_and_constant_ones) {
  const std::string user = std::to_string(0x8 | 0x400), linear = std::to_string(0x4), constant = std::to_string(0x2),
                    next = std::to_string(0x2 | 0x100);
  const auto move = [&](const std::string& flags, const std::string& data) {
    return read(fbx("", 1, {{"", "Lcl Translation", curve(k_two_keys, "0,60", flags, data, "2")}}));
  };
  const Read cubic = move(user, bits(0) + "," + bits(0) + ",218434821,0");
  for (double u = 0; u <= 1; u += 0.1) EXPECT_NEAR(place(cubic, u), 60 * u * u * (3 - 2 * u), 1e-9);
  const Read sloped = move(user, bits(90) + "," + bits(-30) + ",218434821,0");
  for (double u = 0; u <= 1; u += 0.1)
    EXPECT_NEAR(place(sloped, u), 60 * u * u * (3 - 2 * u) + 90 * u * (1 - u) * (1 - u) + 30 * u * u * (1 - u), 1e-9);
  EXPECT_NEAR(place(move(linear, "0,0,0,0"), 0.3), 18, 1e-12);
  EXPECT_EQ(place(move(constant, "0,0,0,0"), 0.9), 0);
  EXPECT_EQ(place(move(next, "0,0,0,0"), 0.1), 60);
  EXPECT_EQ(place(move(next, "0,0,0,0"), 0), 0);
  EXPECT_EQ(move(linear, "0,0,0,0").at(0)[0](1, 3), 5);  // d|Y where there is no curve
}

TEST(FbxCurve, Weighted_tangents_bend_time) {
  // Weights 0.9 and 0.1, in ten-thousandths, share one number; slopes are 0.
  const std::string flags = std::to_string(0x8 | 0x400 | 0x1000000 | 0x2000000);
  const std::string data = "0,0," + std::to_string(9000 + (1000 << 16)) + ",0";
  const Read r = read(fbx("", 1, {{"", "Lcl Translation", curve(k_two_keys, "0,60", flags, data, "2")}}));
  for (double s = 0; s <= 1; s += 0.1) {
    const double q = 1 - s, x = 3 * q * q * s * 0.9 + 3 * q * s * s * 0.9 + s * s * s;
    EXPECT_NEAR(place(r, x), 60 * (3 * q * s * s + s * s * s), 1e-7);
  }
}

TEST(FbxCurve, Goes_on_as_the_file_says) {
  const auto beyond = [&](const char* type, int count) {
    const std::string rule =
        std::string("Post-Extrapolation: {\nType: \"") + type + "\"\nRepetition: " + std::to_string(count) + "\n}\n";
    return read(fbx("", 5, {{"", "Lcl Translation", curve(k_two_keys, "0,60", "4", "0,0,0,0", "2", rule)}}));
  };
  EXPECT_NEAR(place(beyond("R", -1), 2.5), 30, 1e-6);
  EXPECT_NEAR(place(beyond("M", -1), 1.25), 45, 1e-6);
  EXPECT_NEAR(place(beyond("A", -1), 2.5), 150, 1e-6);
  EXPECT_NEAR(place(beyond("A", 1), 4.5), 120, 1e-6);
  EXPECT_NEAR(place(beyond("C", -1), 2.5), 60, 1e-6);
  EXPECT_NEAR(place(beyond("K", -1), 2.5), 150, 1e-6);
}

TEST(FbxCurve, That_is_damaged_is_left_out_and_named) {
  for (const auto& [values, flags, data, runs] : {std::tuple{"0,60,1", "4", "0,0,0,0", "2"},
                                                  {"0,60", "4,4", "0,0,0,0", "2"},
                                                  {"0,60", "4", "0,0,0", "2"},
                                                  {"0,60", "4", "0,0,0,0", "1"},
                                                  {"0,60", "4", "0,0,0,0", "-3"}}) {
    const Read r = read(fbx("", 1, {{"", "Lcl Translation", curve(k_two_keys, values, flags, data, runs)}}));
    ASSERT_EQ(r.character.notes.size(), 1u) << runs;
    EXPECT_NE(r.character.notes[0].find("1 animation curves are damaged"), std::string::npos);
    EXPECT_EQ(place(r, 0.5), 0);
  }
}

std::string setting(const char* name, double value) {
  return "P: \"" + std::string(name) + "\", \"int\", \"Integer\", \"\"," + std::to_string(value) + "\n";
}

TEST(FbxLayers, Add_blend_replace_and_are_silent) {
  const auto moved = [&](const std::string& settings) {
    const std::string base = curve(k_two_keys, "0,60", "4", "0,0,0,0", "2");
    const std::string over = curve(k_two_keys, "10,10", "4", "0,0,0,0", "2");
    return place(read(fbx("", 1, {{"", "Lcl Translation", base}, {settings, "Lcl Translation", over}})), 0.5);
  };
  EXPECT_NEAR(moved(""), 40, 1e-9);
  EXPECT_NEAR(moved(setting("Weight", 50)), 35, 1e-9);
  EXPECT_NEAR(moved(setting("BlendMode", 1)), 10, 1e-9);
  EXPECT_NEAR(moved(setting("BlendMode", 2) + setting("Weight", 25)), 25, 1e-9);
  EXPECT_NEAR(moved(setting("Mute", 1)), 30, 1e-9);
  EXPECT_NEAR(moved(setting("Solo", 1)), 10, 1e-9);
}

TEST(FbxLayers, Rotations_add_as_angles_or_as_rotations) {
  const std::string base = curve(k_two_keys, "20,20", "4", "0,0,0,0", "2");
  const auto turned = [&](double mode) {
    return read(fbx("", 1,
                    {{"", "Lcl Rotation", base}, {setting("RotationAccumulationMode", mode), "Lcl Rotation", base}}))
        .at(0.5)[0];
  };
  const auto order = RotationOrder::k_xyz;
  const Quat one = rotation_of(Vec3(20, 5, 0), order);
  EXPECT_TRUE((turned(0).topLeftCorner<3, 3>().isApprox((one * one).toRotationMatrix(), 1e-12)));
  EXPECT_TRUE(
      (turned(1).topLeftCorner<3, 3>().isApprox(rotation_of(Vec3(40, 10, 0), order).toRotationMatrix(), 1e-12)));
}

TEST(FbxTransform, Without_an_own_space_of_rotation_has_no_pre_rotation_and_no_order) {
  const std::string still = curve(k_two_keys, "20,20", "4", "0,0,0,0", "2");
  const std::string joint = property("PreRotation", 0, 0, 90) + setting("RotationOrder", 5);
  const auto linear = [&](const std::string& more) -> Mat3 {
    return read(fbx(joint + more, 1, {{"", "Lcl Rotation", still}})).at(0)[0].topLeftCorner<3, 3>();
  };
  const Mat3 pre = rotation_of(Vec3(0, 0, 90), RotationOrder::k_xyz).toRotationMatrix();
  EXPECT_TRUE(linear("").isApprox(pre * rotation_of(Vec3(20, 5, 0), RotationOrder::k_zyx).toRotationMatrix(), 1e-12));
  EXPECT_TRUE(linear(setting("RotationActive", 0))
                  .isApprox(rotation_of(Vec3(20, 5, 0), RotationOrder::k_xyz).toRotationMatrix(), 1e-12));
}

TEST(FbxTransform, Pivots_and_offsets_stand_where_the_sdk_has_them) {
  const std::string joint = property("Lcl Translation", 1, 2, 3) + property("RotationOffset", 4, 5, 6) +
                            property("RotationPivot", 7, 8, 9) + property("Lcl Rotation", 10, 20, 30) +
                            property("PostRotation", 40, 50, 60) + property("ScalingOffset", 1, 3, 5) +
                            property("ScalingPivot", 2, 4, 6) + property("Lcl Scaling", 2, 3, 4);
  const auto r = [](double x, double y, double z) {
    return rotation_of(Vec3(x, y, z), RotationOrder::k_xyz).toRotationMatrix();
  };
  const Vec3 p(0.3, -0.2, 0.7), rotation_pivot(7, 8, 9), scaling_pivot(2, 4, 6);
  Vec3 q = Vec3(2, 3, 4).cwiseProduct(p - scaling_pivot) + scaling_pivot + Vec3(1, 3, 5);
  q = r(10, 20, 30) * r(40, 50, 60).transpose() * (q - rotation_pivot) + rotation_pivot;
  q += Vec3(4, 5, 6) + Vec3(1, 2, 3);
  const Mat4 m = read(fbx(joint, 1, {})).at(0)[0];
  EXPECT_LT(((m * p.homogeneous()).head<3>() - q).norm(), 1e-12);
}

TEST(FbxClips, Last_as_long_as_the_file_says) {
  const std::string keys = curve(k_two_keys, "0,60", "4", "0,0,0,0", "2");
  const Read held = read(fbx("", 2, {{"", "Lcl Translation", keys}}));
  EXPECT_EQ(held.character.clips[0].duration(), 2);
  EXPECT_EQ(place(held, 2), 60);
  const Read unknown = read(fbx("", 0, {{"", "Lcl Translation", keys}}));
  EXPECT_EQ(unknown.character.clips[0].duration(), 1);
  const Read shorter = read(fbx("", 0.5, {{"", "Lcl Translation", keys}}));
  EXPECT_EQ(shorter.character.clips[0].duration(), 0.5);
  ASSERT_EQ(shorter.character.notes.size(), 1u);
  EXPECT_NE(shorter.character.notes[0].find("its keys reach"), std::string::npos);
  EXPECT_TRUE(read(fbx("", 1, {})).character.clips.empty());
}

TEST(FbxClips, Name_what_is_not_evaluated) {
  const std::string keys = curve(k_two_keys, "0,1", "4", "0,0,0,0", "2");
  const Read r = read(fbx("", 1, {{"", "Lcl Translation", keys}, {"", "RotationOrder", keys}}));
  ASSERT_EQ(r.character.notes.size(), 1u);
  EXPECT_NE(r.character.notes[0].find("keys of RotationOrder are not evaluated"), std::string::npos);
  EXPECT_NE(r.character.notes[0].find("\"joint\""), std::string::npos);
}

TEST(FbxClips, Percentages_move_shapes_and_those_in_between) {
  const std::string keys = curve(k_two_keys, "0,100", "4", "0,0,0,0", "2");
  std::string text =
      fbx("", 1, {{"", "DeformPercent", keys}}, "Deformer: 2, \"SubDeformer::smile\", \"BlendShapeChannel\" {\n}\n");
  const auto at = text.find("C: \"OP\",30,1,");
  text.replace(at, 13, "C: \"OP\",30,2,");
  const Read r = read(text, {{2, "DeformPercent", 0, 0, {{1, 50}, {0, 100}}}});
  const ClipPose pose(r.character, &r.character.clips[0]);
  std::vector<Mat4> locals(1);
  std::vector<double> morphs(2);
  pose.sample(0.75, locals, morphs);
  EXPECT_NEAR(morphs[1], 0.5, 1e-12);
  EXPECT_NEAR(morphs[0], 0.5, 1e-12);
}

class FbxFaults : public testing::TestWithParam<const char*> {};

TEST_P(FbxFaults, Comes_in_right) {
  FT_REQUIRE_FILE(test::fault_folder(GetParam()));
  const auto imported = import_primary(test::fault_request(GetParam()));
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_LT(test::fault_error(GetParam(), *imported), 6.7e-5);
}

INSTANTIATE_TEST_SUITE_P(Animation, FbxFaults,
                         testing::Values("fbx_cubic", "fbx_layers", "fbx_inherit", "fbx_take_longer_than_keys",
                                         "fbx_dual_quaternion", "fbx_dup2", "fbx_morph"));

}  // namespace
}  // namespace ft

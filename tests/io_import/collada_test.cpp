// Collada: small files written here, read with their meshes, and the folder of faults.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "baker/core/file.h"
#include "io/import/character/clips.h"
#include "io/import/character/pose.h"
#include "io/import/collada/collada_stack.h"
#include "io/import/files/read_character.h"
#include "tests/io_import/faults.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

std::string source(const std::string& id, int width, const std::string& values, bool words = false) {
  int count = 1;
  for (const char c : values) count += c == ' ';
  const std::string array = words ? "Name_array" : "float_array";
  std::string params;
  for (int k = 0; k < width; ++k) params += "<param name=\"P" + std::to_string(k) + "\" type=\"float\"/>";
  return "<source id=\"" + id + "\"><" + array + " id=\"" + id + "-a\" count=\"" + std::to_string(count) + "\">" +
         values + "</" + array + "><technique_common><accessor source=\"#" + id + "-a\" count=\"" +
         std::to_string(count / width) + "\" stride=\"" + std::to_string(width) + "\">" + params +
         "</accessor></technique_common></source>";
}

struct Keys {
  std::string target, times, values, how, into = {}, from = {};
  int width = 1, tangent_width = 2;
};

std::string animation(const std::string& id, const Keys& k) {
  std::string sources =
      source(id + "i", 1, k.times) + source(id + "o", k.width, k.values) + source(id + "n", 1, k.how, true);
  std::string inputs = "<input semantic=\"INPUT\" source=\"#" + id + "i\"/><input semantic=\"OUTPUT\" source=\"#" + id +
                       "o\"/><input semantic=\"INTERPOLATION\" source=\"#" + id + "n\"/>";
  if (!k.into.empty()) {
    sources += source(id + "t", k.tangent_width, k.into) + source(id + "u", k.tangent_width, k.from);
    inputs += "<input semantic=\"IN_TANGENT\" source=\"#" + id + "t\"/><input semantic=\"OUT_TANGENT\" source=\"#" +
              id + "u\"/>";
  }
  return "<animation id=\"" + id + "\">" + sources + "<sampler id=\"" + id + "s\">" + inputs +
         "</sampler><channel source=\"#" + id + "s\" target=\"" + k.target + "\"/></animation>";
}

/// A joint with a place, a rotation about z and a scale, in centimetres and Z-up, below another one.
std::string dae(const std::string& animations, const std::string& more = {}) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset>"
         "<unit name=\"cm\" meter=\"0.01\"/><up_axis>Z_UP</up_axis></asset>" +
         more + "<library_animations>" + animations +
         "</library_animations><library_visual_scenes><visual_scene id=\"s\"><node id=\"hips\" name=\"hips\" "
         "type=\"JOINT\">"
         "<translate sid=\"t\">1 2 3</translate><rotate sid=\"z\">0 0 1 10</rotate><scale sid=\"s\">1 1 2</scale>"
         "<node id=\"head\" name=\"head\" sid=\"top\" type=\"JOINT\"><matrix sid=\"m\">1 0 0 0 0 1 0 0 0 0 1 50 0 0 0 "
         "1</matrix>"
         "</node></node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url=\"#s\"/></scene></COLLADA>";
}

Character read(const std::string& text) {
  const test::ScratchFolder scratch;
  const auto path = scratch / "a.dae";
  std::ofstream(path) << text;
  auto out = read_character(path);
  EXPECT_TRUE(out) << out.error().text();
  if (!out) return {};
  EXPECT_TRUE(check_character(*out));
  return std::move(*out);
}

int node_named(const Character& c, const std::string& name) {
  for (std::size_t i = 0; i < c.nodes.size(); ++i)
    if (c.nodes[i].name == name) return static_cast<int>(i);
  return -1;
}

Mat4 local(const Character& c, const std::string& name, double time) {
  const ClipPose pose(c, c.clips.empty() ? nullptr : &c.clips[0]);
  std::vector<Mat4> locals(c.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  pose.sample(time, locals, morphs);
  return locals[static_cast<std::size_t>(node_named(c, name))];
}

double turn(const Character& c, double time) {
  const Mat4 m = local(c, "hips", time);
  return std::atan2(m(1, 0), m(0, 0)) / k_degree;
}

TEST(Collada, Keys_step_go_straight_and_follow_handles) {
  const auto how = [](const std::string& word, const std::string& into = {}, const std::string& from = {},
                      int width = 2) {
    return read(dae(animation("a", {"hips/z.ANGLE", "0 1", "0 60", word + " " + word, into, from, 1, width})));
  };
  EXPECT_NEAR(turn(how("STEP"), 0.9), 0, 1e-12);
  EXPECT_NEAR(turn(how("LINEAR"), 0.75), 45, 1e-9);
  const Character even = how("BEZIER", "-0.3 0 0.6666666666666667 60", "0.3333333333333333 0 1.3 60");
  const Character late = how("BEZIER", "0 0 0.9 60", "0.9 0 1 60");
  const Character hermite = how("HERMITE", "1 0 1 -30", "1 90 1 0"), values = how("HERMITE", "0 -30", "90 0", 1);
  for (double u = 0.05; u < 1; u += 0.1) {
    const double v = 1 - u;
    EXPECT_NEAR(turn(even, u), 60 * u * u * (3 - 2 * u), 1e-9);
    EXPECT_NEAR(turn(late, 3 * v * v * u * 0.9 + 3 * v * u * u * 0.9 + u * u * u), 60 * u * u * (3 - 2 * u), 1e-9);
    EXPECT_NEAR(turn(hermite, u), 60 * u * u * (3 - 2 * u) + 90 * u * v * v + 30 * u * u * v, 1e-9);
    EXPECT_NEAR(turn(values, u), turn(hermite, u), 1e-9);
  }
  ASSERT_TRUE(how("CARDINAL").notes.size() == 1);
  EXPECT_NE(how("CARDINAL").notes[0].find("none of STEP, LINEAR, BEZIER and HERMITE"), std::string::npos);
}

TEST(Collada, What_is_not_animated_stays_and_animations_of_one_file_are_one_clip) {
  const Character c = read(dae(animation("a", {"hips/t.X", "0 1", "1 5", "LINEAR LINEAR"}) +
                               animation("b", {"hips/s", "0 2", "1 1 2 3 1 2", "LINEAR LINEAR", {}, {}, 3}) +
                               animation("c", {"hips/top/m",
                                               "0 1",
                                               "1 0 0 0 0 1 0 0 0 0 1 50 0 0 0 1 0 -1 0 0 1 0 0 0 0 0 1 70 0 0 0 1",
                                               "STEP STEP",
                                               {},
                                               {},
                                               16})));
  ASSERT_EQ(c.clips.size(), 1u);
  EXPECT_EQ(c.clips[0].duration(), 2);
  const Mat4 m = local(c, "hips", 0.5);
  EXPECT_TRUE((m.topRightCorner<3, 1>().isApprox(Vec3(3, 2, 3))));
  EXPECT_NEAR(m(0, 0), 1.5 * std::cos(10 * k_degree), 1e-12);
  EXPECT_NEAR(m(2, 2), 2, 1e-12);
  EXPECT_NEAR(local(c, "head", 0.9)(2, 3), 50, 1e-12);
  EXPECT_NEAR(local(c, "head", 1.5)(2, 3), 70, 1e-12);
  EXPECT_NEAR(local(c, "head", 1.5)(1, 0), 1, 1e-12);
}

TEST(Collada, Clips_of_the_file_have_their_names_and_their_ranges) {
  const std::string clips =
      "<library_animation_clips><animation_clip id=\"walk\" start=\"0\" end=\"3\"><instance_animation url=\"#a\"/>"
      "</animation_clip><animation_clip id=\"run\" start=\"0.5\" end=\"1\"><instance_animation url=\"#b\"/>"
      "</animation_clip></library_animation_clips>";
  const Character c = read(dae(animation("a", {"hips/t.X", "0 1", "1 5", "LINEAR LINEAR"}) +
                                   animation("b", {"hips/z.ANGLE", "0 1", "0 60", "LINEAR LINEAR"}),
                               clips));
  ASSERT_EQ(c.clips.size(), 2u);
  EXPECT_EQ(c.clips[0].name, "walk");
  EXPECT_EQ(c.clips[0].duration(), 3);
  EXPECT_EQ(c.clips[1].name, "run");
  EXPECT_EQ(c.clips[1].start, 0.5);
  EXPECT_EQ(c.clips[0].stacks.size(), 1u);
}

TEST(Collada, Counts_in_the_unit_of_the_file) {
  const Character c = read(dae(animation("a", {"hips/t.X", "0 1", "1 5", "LINEAR LINEAR"})));
  EXPECT_DOUBLE_EQ(c.file_unit, 0.01);
  std::vector<Mat4> globals(c.nodes.size()), locals;
  for (const CharacterNode& node : c.nodes) locals.push_back(node.local);
  globals_from_locals(c.nodes, locals, globals);
  const Vec3 head = globals[static_cast<std::size_t>(node_named(c, "head"))].topRightCorner<3, 1>();
  EXPECT_TRUE(head.isApprox(Vec3(1, 103, -2), 1e-12));  // 50 times the scale of 2, turned to Y-up
  // Onto a character that counts in metres.
  Character target = c;
  target.file_unit = 1;
  EXPECT_DOUBLE_EQ(unit_ratio(c, target), 0.01);
}

TEST(Collada, Names_what_is_not_evaluated) {
  const Character c = read(dae(animation("a", {"hips/t.X", "0 1", "1 5", "LINEAR LINEAR"}) +
                                   animation("b", {"hips/z.X", "0 1", "0 60", "LINEAR LINEAR"}) +
                                   animation("c", {"face-morph/weights(0)", "0 1", "0 1", "LINEAR LINEAR"}),
                               "<library_physics_models><physics_model id=\"ragdoll\"/></library_physics_models>"));
  const auto noted = [&](const std::string& words) {
    return std::any_of(c.notes.begin(), c.notes.end(),
                       [&](const std::string& n) { return n.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(noted("left out: \"face-morph/weights(0)\", \"hips/z.X\""));
  EXPECT_TRUE(noted("physics in the file is not simulated: \"ragdoll\""));
}

TEST(Collada, Sources_that_claim_more_than_they_hold_are_refused) {
  std::string text = dae(animation("a", {"hips/t.X", "0 1", "1 5", "LINEAR LINEAR"}));
  const auto at = text.find("count=\"2\" stride");
  text.replace(at, 9, "count=\"9\"");
  const test::ScratchFolder scratch;
  const auto path = scratch / "short.dae";
  std::ofstream(path) << text;
  auto file = ColladaFile::open(path);
  ASSERT_TRUE(file);
  EXPECT_FALSE(file->source("#ai"));
  EXPECT_TRUE(file->source("#ao"));
  EXPECT_FALSE(file->source("#missing"));
  for (const char* stride : {"4000000000", "9223372036854775807"}) {  // the second: twice it is -2
    std::string huge = dae(animation("a", {"hips/t.X", "0 1", "1 5", "LINEAR LINEAR"}));
    const auto first = huge.find("stride=\"1\"");
    ASSERT_NE(first, std::string::npos);
    huge.replace(first, 10, std::string("stride=\"") + stride + "\"");
    std::ofstream(path) << huge;
    auto lie = ColladaFile::open(path);
    ASSERT_TRUE(lie);
    EXPECT_FALSE(lie->source("#ai")) << stride;
  }
}

TEST(Collada, A_skin_may_do_without_a_bind_shape_matrix) {
  const auto folder = test::fault_folder("dae_step");
  FT_REQUIRE_FILE(folder);
  const auto bytes = read_file(folder / "d_step.dae");
  ASSERT_TRUE(bytes);
  std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const std::string own = "<bind_shape_matrix>2 0 0 10 0 2 0 0 0 0 2 0 0 0 0 1</bind_shape_matrix>";
  const auto at = text.find(own);
  ASSERT_NE(at, std::string::npos);
  std::string identity = text;
  identity.replace(at, own.size(), "<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>");
  text.erase(at, own.size());
  const Character without = read(text), with = read(identity);
  ASSERT_FALSE(without.meshes.empty());
  ASSERT_EQ(without.meshes[0].bones.size(), with.meshes[0].bones.size());
  EXPECT_TRUE(without.meshes[0].positions == with.meshes[0].positions);
  for (std::size_t b = 0; b < with.meshes[0].bones.size(); ++b)
    EXPECT_TRUE(without.meshes[0].bones[b].inverse_bind == with.meshes[0].bones[b].inverse_bind);
}

TEST(Collada, Comes_in_right) {
  FT_REQUIRE_FILE(test::fault_folder("dae_step"));
  const auto imported = import_primary(test::fault_request("dae_step"));
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_LT(test::fault_error("dae_step", *imported), 6.7e-5);
}

/// The message with which the text is refused; empty when it is read.
std::string refusal(const std::string& text) {
  const test::ScratchFolder scratch;
  const auto path = scratch / "a.dae";
  std::ofstream(path) << text;
  auto out = read_character(path);
  return out ? "" : out.error().what;
}

/// A skinned triangle with a texture coordinate.
std::string skinned() {
  return dae({}, R"(<library_geometries><geometry id="g"><mesh>)" + source("gp", 3, "0 0 0 1 0 0 0 1 0") +
                     source("gt", 2, "0 0 1 1") +
                     R"(<vertices id="gv"><input semantic="POSITION" source="#gp"/></vertices>)"
                     R"(<polylist count="1"><input semantic="VERTEX" source="#gv" offset="0"/>)"
                     R"(<input semantic="TEXCOORD" source="#gt" offset="1"/><vcount>3</vcount><p>0 0 1 1 2 0</p>)"
                     R"(</polylist></mesh></geometry></library_geometries>)"
                     R"(<library_controllers><controller id="c"><skin source="#g">)" +
                     source("cj", 1, "hips top", true) + source("cw", 1, "1 0.5 0.25") +
                     source("cb", 16, "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1") +
                     R"(<joints><input semantic="JOINT" source="#cj"/><input semantic="INV_BIND_MATRIX" source="#cb"/>)"
                     R"(</joints><vertex_weights count="3"><input semantic="JOINT" source="#cj" offset="0"/>)"
                     R"(<input semantic="WEIGHT" source="#cw" offset="1"/><vcount>1 2 1</vcount>)"
                     R"(<v>0 0 0 1 1 1 1 0</v></vertex_weights></skin></controller></library_controllers>)");
}

// Each line is one number changed in a file that is read as it is: assimp alone reads beyond its arrays, goes round
// until the memory ends, or gives a wrong skin.
TEST(Collada, A_count_or_an_index_beyond_what_the_file_holds_is_refused_by_its_element) {
  const std::string good = skinned();
  EXPECT_EQ(refusal(good), "");
  const struct {
    const char *was, *is, *message;
  } cases[] = {
      {"\"gp-a\" count=\"9\"", "\"gp-a\" count=\"10\"", "<float_array> \"gp-a\" is to have 10 values and has 9"},
      {"\"gp-a\" count=\"9\"", "\"gp-a\" count=\"1999999999\"", "<float_array> \"gp-a\" is to have 1999999999 values"},
      {"\"gp-a\" count=\"9\"", "\"gp-a\" count=\"8\"",
       "<accessor> in \"gp\" takes more than the 8 values of its array"},
      {"count=\"3\" stride=\"3\"", "count=\"4\" stride=\"3\"", "<accessor> in \"gp\" takes more than the 9 values"},
      {"count=\"3\" stride=\"3\"", "count=\"3\" stride=\"4\"", "<accessor> in \"gp\" takes more than the 9 values"},
      {"count=\"3\" stride=\"3\"", "count=\"2\" stride=\"3\"", "<p> in \"g\" has the index 2 of 2 values"},
      {"<p>0 0 1", "<p>0 2 1", "<p> in \"g\" has the index 2 of 2 values"},
      {"<p>0 0 1", "<p>0 x 1", "<p> in \"g\" has \"x\" where an index belongs"},
      {"<p>0 0 1", "<p>0 .5 1", "<p> in \"g\" has \".5\" where an index belongs"},
      {"<p>0 0 1", "<p>-1 0 1", "<p> in \"g\" has \"-1\" where an index belongs"},
      {"<p>0 0 1", "<p>0 1", "<p> in \"g\" has 5 indices, 2 of them to a point"},
      {"<vcount>3<", "<vcount>4<", "<polylist> in \"g\" is to have 4 points and has 3"},
      {"<vcount>3<", "<vcount>4000000000<", "<polylist> in \"g\" is to have 4000000000 points and has 3"},
      {"<polylist count=\"1\"", "<polylist count=\"2\"", "<polylist> in \"g\" is to have 2 parts and has 1"},
      {"#gt\" offset=\"1\"", "#gt\" offset=\"99999999\"", "<polylist> in \"g\" has an input at offset 99999999"},
      {"weights count=\"3\"", "weights count=\"99999999\"",
       "<vertex_weights> in \"c\" is to have 99999999 parts and has 3"},
      {"weights count=\"3\"", "weights count=\"2\"", "<vertex_weights> in \"c\" is for 2 vertices, and \"g\" has 3"},
      {"<vcount>1 2 1<", "<vcount>1 9 1<",
       "<vertex_weights> in \"c\" is to have 11 pairs of joint and weight and has 8"},
      {"<v>0 0 0 1 1", "<v>0 0 0 1 2", "<vertex_weights> in \"c\" has the joint 2 of 2"},
      {"<v>0 0 0 1 1", "<v>0 3 0 1 1", "<vertex_weights> in \"c\" has the weight 3 of 3"},
      {"<v>0 0 0 1 1", "<v>0 x 0 1 1", "<v> in \"c\" has \"x\" where an index belongs"},
      {"\"cb-a\" count=\"32\">1", "\"cb-a\" count=\"31\">", "<accessor> in \"cb\" takes more than the 31 values"},
  };
  for (const auto& c : cases) {
    std::string bad = good;
    const auto place = bad.find(c.was);
    ASSERT_NE(place, std::string::npos) << c.was;
    bad.replace(place, std::string(c.was).size(), c.is);
    EXPECT_NE(refusal(bad).find(c.message), std::string::npos) << c.is << ": " << refusal(bad);
  }
}

}  // namespace
}  // namespace ft

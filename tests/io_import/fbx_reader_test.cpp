// Bodies from FBX files, on small text files written here: polygons, geometric transforms, skins, blend shapes,
// visibility, and a word on what is not evaluated.
#include <gtest/gtest.h>

#include <cmath>

#include "io/import/body/skin.h"
#include "io/import/character/polygons.h"
#include "io/import/character/pose.h"
#include "io/import/fbx/read_fbx.h"

namespace ft {
namespace {

/// A text file of objects and connections.
struct TextFile {
  std::string objects, connections;

  TextFile& object(const std::string& kind, int id, const std::string& name, const std::string& subkind,
                   const std::string& body) {
    objects +=
        kind + ": " + std::to_string(id) + ", \"" + kind + "::" + name + "\", \"" + subkind + "\" {\n" + body + "\n}\n";
    return *this;
  }
  TextFile& model(int id, const std::string& name, const std::string& properties, int parent) {
    object("Model", id, name, "Mesh", "Properties70: {\n" + properties + "\n}");
    return connect(id, parent);
  }
  TextFile& connect(int source, int destination, const std::string& property = {}) {
    connections += property.empty() ? "C: \"OO\"," : "C: \"OP\",";
    connections += std::to_string(source) + "," + std::to_string(destination);
    connections += property.empty() ? "\n" : ",\"" + property + "\"\n";
    return *this;
  }
  Result<Character> read() const {
    const std::string text =
        "; FBX 7.4.0 project file\nObjects: {\n" + objects + "}\nConnections: {\n" + connections + "}\n";
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    auto character = read_fbx(Bytes(first, first + text.size()));
    if (character)
      if (Status s = check_character(*character); !s) return s.error();
    return character;
  }
};

std::string array(const std::string& name, const std::vector<double>& values) {
  std::string out = name + ": *" + std::to_string(values.size()) + " {\na: ";
  for (std::size_t k = 0; k < values.size(); ++k) out.append(k > 0 ? "," : "").append(std::to_string(values[k]));
  return out + "\n}\n";
}

std::string whole(const std::string& name, const std::vector<int>& values) {
  std::string out = name + ": *" + std::to_string(values.size()) + " {\na: ";
  for (std::size_t k = 0; k < values.size(); ++k) out.append(k > 0 ? "," : "").append(std::to_string(values[k]));
  return out + "\n}\n";
}

std::string three(const std::string& name, double x, double y, double z) {
  return "P: \"" + name + "\", \"Vector3D\", \"Vector\", \"\"," + std::to_string(x) + "," + std::to_string(y) + "," +
         std::to_string(z) + "\n";
}

std::string one(const std::string& name, double x) {
  return "P: \"" + name + "\", \"Number\", \"\", \"A\"," + std::to_string(x) + "\n";
}

std::string matrix(const std::string& name, const Mat4& m) {
  return array(name, std::vector<double>(m.data(), m.data() + 16));
}

const std::string k_quad =
    array("Vertices", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + whole("PolygonVertexIndex", {0, 1, 2, -4});

/// Where the rest pose puts the vertices of one mesh; all are used by a face and none are joined.
std::vector<Vec3> rest_positions(const Character& character, int mesh, const std::vector<double>* morphs = nullptr) {
  std::vector<std::string> notes;
  const Skin skin = weld(character, {mesh}, notes);
  const ClipPose rest(character, nullptr);
  std::vector<Mat4> globals(character.nodes.size());
  globals_from_locals(character.nodes, rest.rest(), globals);
  std::vector<Vec3> out(skin.base.size());
  deform(skin, Mat4::Identity(), globals, morphs != nullptr ? std::span<const double>(*morphs) : rest.rest_morphs(),
         out);
  return out;
}

bool has_note(const Character& character, const std::string& words) {
  for (const std::string& note : character.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

Mat4 moved(double x, double y, double z) {
  Mat4 out = Mat4::Identity();
  out.topRightCorner<3, 1>() = Vec3(x, y, z);
  return out;
}

double area(const std::vector<Triangle>& triangles, const std::vector<Vec3>& p) {
  double sum = 0;
  for (const Triangle& t : triangles)
    sum += 0.5 * (p[static_cast<std::size_t>(t[1])] - p[static_cast<std::size_t>(t[0])])
                     .cross(p[static_cast<std::size_t>(t[2])] - p[static_cast<std::size_t>(t[0])])
                     .z();
  return sum;
}

TEST(SplitPolygon, Concave_polygons_are_covered_once) {
  const auto check = [](const std::vector<Vec3>& p, double right) {
    std::vector<int> corners(p.size());
    // From every first corner: no order of them is special.
    for (std::size_t shift = 0; shift < p.size(); ++shift) {
      for (std::size_t k = 0; k < p.size(); ++k) corners[k] = static_cast<int>((k + shift) % p.size());
      std::vector<Triangle> triangles;
      split_polygon(corners, p, triangles);
      EXPECT_EQ(triangles.size(), p.size() - 2);
      EXPECT_NEAR(area(triangles, p), right, 1e-12);
      for (const Triangle& t : triangles) EXPECT_GE(area({t}, p), 0) << shift;  // none lies outside, turned over
    }
  };
  check({{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}}, 1.0);                                          // arrow
  check({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, 5.0);                        // L
  check({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 1, 0}, {2, 3, 0}, {1, 1, 0}, {0, 3, 0}}, 8.0);             // crown
  check({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}}, 4.0);  // straight
}

TEST(FbxReader, Polygons_of_any_size_and_what_is_wrong_with_them) {
  const std::string body = array("Vertices", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0}) +
                           whole("PolygonVertexIndex", {0, 1, 2, -4, 1, 4, -3, 0, -2, -1, 0, 1, -100, 0, 1, 2});
  const auto c = TextFile().model(1, "a", "", 0).object("Geometry", 2, "g", "Mesh", body).connect(2, 1).read();
  ASSERT_TRUE(c) << c.error().text();
  ASSERT_EQ(c->meshes.size(), 1u);
  EXPECT_EQ(c->meshes[0].triangles.size(), 3u);
  EXPECT_TRUE(has_note(*c, "2 polygons have one or two corners"));
  EXPECT_TRUE(has_note(*c, "1 polygons name a vertex that is not there"));
  EXPECT_TRUE(has_note(*c, "1 meshes end within a polygon"));
}

TEST(FbxReader, A_geometry_used_by_two_models_is_two_meshes_each_with_its_geometric_transform) {
  TextFile file;
  file.model(1, "a", three("Lcl Translation", 10, 0, 0) + three("GeometricTranslation", 0, 5, 0), 0);
  file.model(2, "b", three("GeometricRotation", 0, 0, 90) + three("GeometricScaling", 2, 1, 1), 1);
  file.object("Geometry", 3, "g", "Mesh", k_quad).connect(3, 1).connect(3, 2);
  const auto c = file.read();
  ASSERT_TRUE(c) << c.error().text();
  ASSERT_EQ(c->meshes.size(), 2u);
  EXPECT_NEAR((rest_positions(*c, 0)[2] - Vec3(11, 6, 0)).norm(), 0, 1e-12);
  // A child does not take over what moves its parent's mesh only.
  EXPECT_NEAR((rest_positions(*c, 1)[1] - Vec3(10, 2, 0)).norm(), 0, 1e-12);
}

/// A quad whose corners 0 and 1 follow joint 11, and 2 and 3 joint 12, both called "joint".
TextFile skinned(const std::string& skin_body, const std::string& lower, const std::string& upper,
                 const std::string& mesh_properties) {
  TextFile file;
  file.model(1, "body", mesh_properties, 0).model(11, "joint", lower, 0).model(12, "joint", upper, 0);
  file.object("Geometry", 2, "g", "Mesh", k_quad).connect(2, 1);
  file.object("Deformer", 3, "skin", "Skin", skin_body).connect(3, 2);
  for (const int k : {0, 1}) {
    file.object("Deformer", 4 + k, "c", "Cluster",
                whole("Indexes", {2 * k, 2 * k + 1}) + array("Weights", {1, 1}) + matrix("Transform", moved(0, -k, 0)) +
                    matrix("TransformLink", moved(0, k, 0)));
    file.connect(4 + k, 3).connect(11 + k, 4 + k);
  }
  return file;
}

TEST(FbxReader, Joints_of_one_name_are_told_apart_by_their_id) {
  const auto c = skinned("", three("Lcl Translation", 5, 0, 0), three("Lcl Translation", 0, 3, 0), "").read();
  ASSERT_TRUE(c) << c.error().text();
  const auto p = rest_positions(*c, 0);
  EXPECT_NEAR((p[1] - Vec3(6, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((p[2] - Vec3(1, 3, 0)).norm(), 0, 1e-12);
}

TEST(FbxReader, A_skinned_mesh_keeps_its_geometric_transform_and_does_not_follow_its_node) {
  const auto c = skinned("", "", three("Lcl Translation", 0, 1, 0),
                         three("Lcl Translation", 100, 0, 0) + three("GeometricTranslation", 0, 0, 7))
                     .read();
  ASSERT_TRUE(c) << c.error().text();
  EXPECT_NEAR((rest_positions(*c, 0)[2] - Vec3(1, 1, 7)).norm(), 0, 1e-12);
}

TEST(FbxReader, A_cluster_without_a_bone_or_a_bind_matrix_is_named) {
  TextFile file = skinned("", "", three("Lcl Translation", 0, 1, 0), "");
  file.object("Deformer", 6, "lost", "Cluster", whole("Indexes", {0}) + array("Weights", {1})).connect(6, 3);
  file.object("Deformer", 7, "bare", "Cluster", whole("Indexes", {0, 99}) + array("Weights", {1, 1}));
  file.connect(7, 3).connect(12, 7);
  const auto c = file.read();
  ASSERT_TRUE(c) << c.error().text();
  EXPECT_TRUE(has_note(*c, "1 clusters of skins have no bone"));
  EXPECT_TRUE(has_note(*c, "1 clusters have no bind matrix"));
  EXPECT_TRUE(has_note(*c, "1 skin weights were negative"));
  EXPECT_TRUE(has_note(*c, "weights normalised"));
  // Bound where it rests: nothing moves.
  EXPECT_NEAR(rest_positions(*c, 0)[0].norm(), 0, 1e-12);
}

/// Two joints at the origin, the second turned by 90 degrees about x; every corner follows both by half.
Result<Character> twisted(const std::string& skin_body) {
  TextFile file;
  file.model(1, "body", "", 0).model(11, "a", "", 0).model(12, "b", three("Lcl Rotation", 90, 0, 0), 0);
  file.object("Geometry", 2, "g", "Mesh", k_quad).connect(2, 1);
  file.object("Deformer", 3, "skin", "Skin", skin_body).connect(3, 2);
  for (const int k : {0, 1}) {
    file.object("Deformer", 4 + k, "c", "Cluster",
                whole("Indexes", {0, 1, 2, 3}) + array("Weights", {0.5, 0.5, 0.5, 0.5}) +
                    matrix("Transform", Mat4::Identity()) + matrix("TransformLink", Mat4::Identity()));
    file.connect(4 + k, 3).connect(11 + k, 4 + k);
  }
  return file.read();
}

TEST(FbxReader, Dual_quaternions_keep_the_radius_that_linear_blending_loses) {
  const auto radius = [](const Result<Character>& c, std::size_t vertex) {
    EXPECT_TRUE(c);
    const Vec3 p = rest_positions(*c, 0)[vertex];
    return std::hypot(p.y(), p.z());
  };
  EXPECT_NEAR(radius(twisted(""), 3), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(radius(twisted("SkinningType: \"Linear\""), 3), std::sqrt(0.5), 1e-12);
  const auto dual = twisted("SkinningType: \"DualQuaternion\"");
  EXPECT_NEAR(radius(dual, 3), 1, 1e-12);
  EXPECT_NEAR((rest_positions(*dual, 0)[3] - Vec3(0, std::sqrt(0.5), std::sqrt(0.5))).norm(), 0, 1e-12);
  const auto blend = twisted("SkinningType: \"Blend\"\n" + whole("Indexes", {2, 3}) + array("BlendWeights", {1, 0.25}));
  EXPECT_NEAR(radius(blend, 2), 1, 1e-12);
  EXPECT_NEAR(radius(blend, 3), 0.75 * std::sqrt(0.5) + 0.25, 1e-12);
  EXPECT_TRUE(has_note(*twisted("SkinningType: \"Rigid\""), "4 vertices of rigid skins have several bones"));
}

TEST(FbxReader, Dual_quaternions_survive_the_way_from_the_child) {
  const auto c = twisted("SkinningType: \"DualQuaternion\"");
  ASSERT_TRUE(c);
  const auto back = load_character_bytes(save_character(*c));
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->meshes[0].dual_share, c->meshes[0].dual_share);
  Character bad = *c;
  bad.meshes[0].dual_share[0] = 1.5;
  EXPECT_FALSE(check_character(bad));
}

Result<Character> shaped(double percent, const std::vector<double>& full) {
  TextFile file;
  file.model(1, "body", "", 0).object("Geometry", 2, "g", "Mesh", k_quad).connect(2, 1);
  file.object("Deformer", 3, "shapes", "BlendShape", "").connect(3, 2);
  file.object("Deformer", 4, "channel", "BlendShapeChannel",
              "Properties70: {\n" + one("DeformPercent", percent) + "}\n" + array("FullWeights", full));
  file.connect(4, 3);
  for (std::size_t k = 0; k < full.size(); ++k) {
    const int id = 10 + static_cast<int>(k);
    file.object("Geometry", id, "s", "Shape",
                whole("Indexes", {2}) + array("Vertices", {0, 0, full[k] * full[k] / 10000}));
    file.connect(id, 4);
  }
  return file.read();
}

TEST(FbxReader, Shapes_in_between_are_joined_by_straight_lines_also_without_keys) {
  const auto depth = [](double percent, const std::vector<double>& full) {
    const auto c = shaped(percent, full);
    EXPECT_TRUE(c);
    return c ? rest_positions(*c, 0)[2].z() : 1e9;
  };
  EXPECT_NEAR(depth(0, {100}), 0, 1e-12);
  EXPECT_NEAR(depth(40, {100}), 0.4, 1e-9);
  EXPECT_NEAR(depth(25, {50, 100}), 0.125, 1e-9);
  EXPECT_NEAR(depth(50, {50, 100}), 0.25, 1e-9);
  EXPECT_NEAR(depth(75, {100, 50}), 0.625, 1e-9);  // in any order
  EXPECT_NEAR(depth(-25, {-50, 50, 100}), 0.125, 1e-9);
}

TEST(FbxReader, What_the_file_hides_is_not_visible) {
  TextFile file;
  file.model(1, "hidden", one("Visibility", 0), 0).model(2, "below", "", 1);
  file.model(3, "kept", one("Visibility Inheritance", 0), 1).model(4, "unshown", one("Show", 0), 0);
  file.object("Geometry", 5, "g", "Mesh", k_quad);
  for (const int model : {1, 2, 3, 4}) file.connect(5, model);
  const auto c = file.read();
  ASSERT_TRUE(c) << c.error().text();
  ASSERT_EQ(c->meshes.size(), 4u);
  for (const CharacterMesh& mesh : c->meshes)
    EXPECT_EQ(mesh.visible, c->nodes[static_cast<std::size_t>(mesh.node)].name == "kept");
}

TEST(FbxReader, What_cannot_be_evaluated_is_named) {
  TextFile file;
  file.model(1, "arm", "", 0).object("Constraint", 2, "aim", "Aim", "").connect(2, 1);
  file.object("Geometry", 3, "coat", "NurbsSurface", "").connect(3, 1);
  const auto c = file.read();
  ASSERT_TRUE(c) << c.error().text();
  EXPECT_TRUE(has_note(*c, "1 constraints (\"arm\")"));
  EXPECT_TRUE(has_note(*c, "1 NURBS surfaces (\"arm\")"));
  ASSERT_EQ(c->contents.size(), 2u);
  EXPECT_NE(c->contents[0].use.find("polygons"), std::string::npos);
}

TEST(FbxReader, A_node_below_itself_is_refused_by_name) {
  const auto c = TextFile().model(1, "a", "", 2).model(2, "b", "", 1).model(3, "c", "", 0).read();
  ASSERT_FALSE(c);
  EXPECT_NE(c.error().what.find("\"a\" stands below itself"), std::string::npos);
}

TEST(FbxReader, Units_and_axes_are_those_of_the_file) {
  const std::string text =
      "; FBX 7.4.0\nGlobalSettings: {\n Properties70: {\n  P: \"UpAxis\", \"int\", \"Integer\", \"\",2\n"
      "  P: \"FrontAxis\", \"int\", \"Integer\", \"\",1\n  P: \"FrontAxisSign\", \"int\", \"Integer\", \"\",-1\n"
      "  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",2.54\n }\n}\n"
      "Objects: {\n Model: 1, \"Model::a\", \"Null\" {\n }\n}\n";
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  const auto c = read_fbx(Bytes(first, first + text.size()));
  ASSERT_TRUE(c) << c.error().text();
  EXPECT_NEAR(c->file_unit, 0.0254, 1e-15);
  EXPECT_EQ(c->file_up, "z");
  EXPECT_EQ(c->file_axes * Vec3::UnitZ(), Vec3::UnitY());
  EXPECT_TRUE(c->notes.empty());
}

}  // namespace
}  // namespace ft

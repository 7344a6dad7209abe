// What makes shapes and motion in glTF, on files of a few vertices made here: weights and skins, positions and faces,
// morph targets, keys, scenes, extensions.
#include <algorithm>
#include <cmath>

#include "tests/io_import/tiny_gltf.h"

namespace ft {
namespace {

using namespace test;

TEST(GltfReader, Weights_of_every_kind_are_fractions) {
  expect_weights(good(skinned_square([](TinyGltf& f, Json& a) { put_weights<float>(f, a, 5126, 1, false); })), 1e-7);
  expect_weights(good(skinned_square([](TinyGltf& f, Json& a) { put_weights<std::uint8_t>(f, a, 5121, 255, true); })),
                 1e-9);
  expect_weights(
      good(skinned_square([](TinyGltf& f, Json& a) { put_weights<std::uint16_t>(f, a, 5123, 65535, true); })), 1e-9);
}

TEST(GltfReader, Weights_that_do_not_sum_to_one_are_made_to_and_noted) {
  const Character c = good(skinned_square([](TinyGltf& f, Json& a) { put_weights<float>(f, a, 5126, 0.5, false); }));
  expect_weights(c, 1e-7);
  EXPECT_TRUE(says(c.notes, "weights normalised (sums 0.5..")) << c.notes.front();
}

TEST(GltfReader, A_second_set_of_joints_counts) {
  const Character c = good(skinned_square([](TinyGltf& f, Json& a) {
    std::vector<std::uint8_t> zero(16, 0), one(16, 1);
    std::vector<float> quarter(16, 0.0f), rest(16, 0.0f);
    for (std::size_t v = 0; v < 4; ++v) quarter[4 * v] = 0.25f, rest[4 * v + 3] = 0.75f;
    a["JOINTS_0"] = f.accessor(f.view(zero), 5121, "VEC4", 4), a["JOINTS_1"] = f.accessor(f.view(one), 5121, "VEC4", 4);
    a["WEIGHTS_0"] = f.floats(quarter, "VEC4"), a["WEIGHTS_1"] = f.floats(rest, "VEC4");
  }));
  EXPECT_EQ(c.meshes.at(0).influence_bone, (std::vector<int>{0, 1, 0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(c.meshes[0].influence_weight[1], 0.75);
}

TEST(GltfReader, A_skin_without_inverse_bind_matrices_has_identities) {
  const Character c =
      good(skinned_square([](TinyGltf& f, Json& a) { put_weights<float>(f, a, 5126, 1, false); }, false));
  ASSERT_EQ(c.meshes.at(0).bones.size(), 2u);
  EXPECT_EQ(c.meshes[0].bones[1].inverse_bind, Mat4::Identity());
  EXPECT_EQ(c.nodes[static_cast<std::size_t>(c.meshes[0].bones[1].node)].name, "high");
}

TEST(GltfReader, A_mesh_at_two_nodes_has_the_skin_of_each) {
  TinyGltf file = skinned_square([](TinyGltf& f, Json& a) { put_weights<float>(f, a, 5126, 1, false); });
  file.node({{"mesh", 0}, {"skin", 1}});
  file.node({{"mesh", 0}});
  file.node({{"name", "low"}}), file.node({{"name", "high"}});
  file.push("skins", {{"joints", {5, 6}}});
  const Character c = good(file);
  ASSERT_EQ(c.meshes.size(), 3u);
  EXPECT_EQ(c.meshes[0].bones[0].node, 2);
  EXPECT_EQ(c.meshes[1].bones[0].node, 6);  // behind ROOT
  EXPECT_TRUE(c.meshes[2].bones.empty());
  EXPECT_EQ(c.meshes[2].positions, c.meshes[0].positions);
}

TEST(GltfReader, A_joint_that_the_skin_does_not_have_is_refused) {
  TinyGltf file = skinned_square([](TinyGltf& f, Json& a) { put_weights<float>(f, a, 5126, 1, false); }, false);
  file.json["skins"][0]["joints"] = {1};
  expect_refused(file, "names joint 1 of skins[0], which has 1");
}

TEST(GltfReader, Positions_of_every_kind_are_read_with_strides) {
  // KHR_mesh_quantization: each kind, normalised or not, with padding behind each vertex.
  const auto with = [&]<class T>(T one, int component, bool normalized, double expected) {
    const Character c = good(square_with([&](TinyGltf& file, Json& primitive) {
      std::vector<T> values;
      for (std::size_t v = 0; v < 4; ++v) {
        for (std::size_t k = 0; k < 3; ++k) values.push_back(static_cast<T>(test::k_square[3 * v + k]) * one);
        values.resize(values.size() + 8 / sizeof(T) * 2 - 3, static_cast<T>(77));
      }
      const int view = file.view(values, 16);
      primitive["attributes"]["POSITION"] = file.accessor(view, component, "VEC3", 4, normalized);
      file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    }));
    ASSERT_EQ(c.meshes.size(), 1u);
    EXPECT_EQ(c.meshes[0].positions[2], Vec3(expected, expected, 0));
  };
  with(std::int8_t{127}, 5120, true, 1), with(std::int8_t{-128}, 5120, true, -1), with(std::int8_t{5}, 5120, false, 5);
  with(std::uint8_t{255}, 5121, true, 1), with(std::int16_t{32767}, 5122, true, 1);
  with(std::int16_t{-300}, 5122, false, -300), with(std::uint16_t{65535}, 5123, true, 1);
  with(2.5f, 5126, false, 2.5);
}

TEST(GltfReader, Sparse_values_are_put_over_what_is_there_or_over_zeros) {
  for (const bool over_zeros : {false, true}) {
    const Character c = good(square_with([&](TinyGltf& file, Json& primitive) {
      Json& accessor = file.json["accessors"][0];
      const int indices = file.view(std::vector<std::uint8_t>{1, 3}),
                values = file.view(std::vector<float>{7, 8, 9, 4, 5, 6});
      accessor["sparse"] = {{"count", 2},
                            {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                            {"values", {{"bufferView", values}}}};
      if (over_zeros) accessor.erase("bufferView");
      static_cast<void>(primitive);
    }));
    const std::vector<Vec3> expected = {Vec3::Zero(), {7, 8, 9}, over_zeros ? Vec3(0, 0, 0) : Vec3(1, 1, 0), {4, 5, 6}};
    EXPECT_EQ(c.meshes.at(0).positions, expected);
  }
}

TEST(GltfReader, Triangles_of_every_mode_with_and_without_indices) {
  using Triangles = std::vector<Triangle>;
  for (const bool indexed : {false, true})
    for (const auto& [mode, expected] : {std::pair<int, Triangles>{4, {{0, 1, 2}, {3, 4, 5}}},
                                         {5, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}},
                                         {6, {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}}}}) {
      TinyGltf file;
      const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0}, "VEC3");
      Json primitive = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
      if (indexed)
        primitive["indices"] =
            file.accessor(file.view(std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}), 5125, "SCALAR", 6);
      file.push("meshes", {{"primitives", Json::array({primitive})}});
      file.node({{"mesh", 0}});
      EXPECT_EQ(good(file).meshes.at(0).triangles, expected) << mode;
    }
}

TEST(GltfReader, Points_and_lines_are_left_out_with_a_note) {
  TinyGltf file = square_with([](TinyGltf&, Json& primitive) { primitive["mode"] = 1; });
  const Character c = good(file);
  EXPECT_TRUE(c.meshes.empty());
  EXPECT_TRUE(says(c.notes, "1 primitives are points or lines; left out"));
}

TEST(GltfReader, Primitives_of_one_mesh_are_pieces_and_keep_the_vertices_they_use) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  const int corner = file.accessor(file.view(std::vector<std::uint8_t>{0, 2, 3}), 5121, "SCALAR", 3);
  Json second = {{"attributes", {{"POSITION", 0}}}, {"indices", corner}};
  file.json["meshes"][0]["primitives"].push_back(second);
  file.json["meshes"][0]["name"] = "sheet";
  const Character c = good(file);
  ASSERT_EQ(c.meshes.size(), 2u);
  EXPECT_EQ(c.meshes[0].name, "sheet-0");
  EXPECT_EQ(c.meshes[1].name, "sheet-1");
  EXPECT_EQ(c.meshes[1].positions[static_cast<std::size_t>(c.meshes[1].triangles[0][2])], Vec3(0, 1, 0));
  EXPECT_EQ(c.meshes[1].positions.size(), 3u);
}

TEST(GltfReader, Vertices_that_no_face_of_a_primitive_uses_say_nothing_of_it) {
  TinyGltf file = skinned_square([](TinyGltf& f, Json& a) { put_weights<float>(f, a, 5126, 1, false); });
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["indices"] = file.accessor(file.view(std::vector<std::uint8_t>{0, 1, 2}), 5121, "SCALAR", 3);
  primitive["attributes"]["JOINTS_0"] = file.accessor(
      file.view(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 70, 1, 0, 0}), 5121, "VEC4", 4);
  primitive["targets"] = Json::array({{{"POSITION", file.floats({0, 0, 0, 0, 0, 0, 0, 0, 5, 9, 9, 9}, "VEC3")}}});
  const Character c = good(file);
  ASSERT_EQ(c.meshes.size(), 1u);
  EXPECT_EQ(c.meshes[0].positions.size(), 3u);
  EXPECT_EQ(c.meshes[0].morphs.at(0).deltas.size(), 3u);
  EXPECT_EQ(c.meshes[0].morphs[0].deltas[2], Vec3(0, 0, 5));
  EXPECT_EQ(c.meshes[0].influence_start.size(), 4u);
}

TEST(GltfReader, An_index_beyond_the_vertices_is_refused) {
  expect_refused(
      square_with([](TinyGltf& file, Json& primitive) {
        primitive["indices"] = file.accessor(file.view(std::vector<std::uint16_t>{0, 1, 4}), 5123, "SCALAR", 3);
      }),
      "a triangle names vertex 4 of 4");
}

TEST(GltfReader, Morph_targets_have_names_and_the_weights_of_the_node_come_first) {
  TinyGltf file = square_with([](TinyGltf& f, Json& primitive) {
    const int smile = f.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int sparse = f.accessor(-1, 5126, "VEC3", 4);
    const int indices = f.view(std::vector<std::uint16_t>{2}), values = f.view(std::vector<float>{0.5f, 0, 0});
    f.json["accessors"][static_cast<std::size_t>(sparse)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    primitive["targets"] = Json::array({{{"POSITION", smile}}, {{"POSITION", sparse}}, Json::object()});
  });
  file.json["meshes"][0]["extras"] = {{"targetNames", {"smile", "frown", "shine"}}};
  file.json["meshes"][0]["weights"] = {0.25, 0.5, 0.75};
  const Character by_mesh = good(file);
  EXPECT_EQ(by_mesh.nodes[0].morph_weights, (std::vector<double>{0.25, 0.5, 0.75}));
  file.json["nodes"][0]["weights"] = {0, 1, 0};
  const Character c = good(file);
  EXPECT_EQ(c.nodes[0].morph_weights, (std::vector<double>{0, 1, 0}));
  ASSERT_EQ(c.meshes.at(0).morphs.size(), 3u);
  EXPECT_EQ(c.meshes[0].morphs[0].name, "smile");
  EXPECT_EQ(c.meshes[0].morphs[2].name, "shine");
  EXPECT_EQ(c.meshes[0].morphs[0].deltas[3], Vec3(0, 0, 1));
  EXPECT_EQ(c.meshes[0].morphs[1].deltas[2], Vec3(0.5, 0, 0));
  EXPECT_EQ(c.meshes[0].morphs[1].deltas[1], Vec3::Zero());
}

TEST(GltfReader, Keys_keep_their_interpolation_and_sparse_or_absent_bytes) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  const int times = file.floats({0, 1, 2}, "SCALAR");
  const int sparse = file.accessor(-1, 5126, "VEC3", 3);
  const int indices = file.view(std::vector<std::uint8_t>{1}), values = file.view(std::vector<float>{1, 2, 3});
  file.json["accessors"][static_cast<std::size_t>(sparse)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  const int one_time = file.accessor(-1, 5126, "SCALAR", 1);
  const int turn = file.accessor(file.view(std::vector<std::int16_t>{0, 0, 32767, 0}), 5122, "VEC4", 1, true);
  const int scales = file.floats(std::vector<float>(27, 2), "VEC3");
  file.push("animations",
            {{"name", "all"},
             {"samplers", Json::array({{{"input", times}, {"output", sparse}, {"interpolation", "STEP"}},
                                       {{"input", one_time}, {"output", turn}},
                                       {{"input", times}, {"output", scales}, {"interpolation", "CUBICSPLINE"}}})},
             {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
                                       {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}},
                                       {{"sampler", 2}, {"target", {{"node", 0}, {"path", "scale"}}}}})}});
  const Character c = good(file);
  ASSERT_EQ(c.clips.size(), 1u);
  const Channel& channel = c.clips[0].channels.at(0);
  EXPECT_EQ(channel.translation.interpolation, KeyInterpolation::k_step);
  EXPECT_EQ(channel.translation.values, (std::vector<double>{0, 0, 0, 1, 2, 3, 0, 0, 0}));
  EXPECT_EQ(channel.rotation.times, std::vector<double>{0});
  EXPECT_EQ(channel.rotation.values, (std::vector<double>{0, 0, 1, 0}));
  EXPECT_EQ(channel.scale.interpolation, KeyInterpolation::k_cubic);
  EXPECT_EQ(c.clips[0].end, 2);
}

TEST(GltfReader, Pointers_to_nodes_are_channels_and_others_are_noted) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  const int times = file.floats({0, 1}, "SCALAR"), moves = file.floats({0, 0, 0, 1, 2, 3}, "VEC3");
  const auto pointer = [](const char* to) -> Json {
    return {{"sampler", 0},
            {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", to}}}}}}}};
  };
  file.push("animations", {{"samplers", Json::array({{{"input", times}, {"output", moves}}})},
                           {"channels", Json::array({pointer("/nodes/0/translation"), pointer("/meshes/0/weights/0"),
                                                     pointer("/materials/0/emissiveFactor")})}});
  const Character c = good(file);
  EXPECT_EQ(c.clips.at(0).channels.at(0).translation.values[5], 3);
  EXPECT_TRUE(says(c.notes, "1 animation channels move what is not animated here")) << c.notes.size();
  EXPECT_TRUE(says(c.notes, "/meshes/0/weights/0"));
}

TEST(GltfReader, Keys_that_do_not_match_their_times_are_refused_by_name) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  const int times = file.floats({0, 1}, "SCALAR"), moves = file.floats({0, 0, 0}, "VEC3");
  file.push("animations",
            {{"name", "walk"},
             {"samplers", Json::array({{{"input", times}, {"output", moves}}})},
             {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})}});
  expect_refused(file, "animations[0] \"walk\", channels[0] (translation of nodes[0]): has 2 key times and 3 numbers");
}

TEST(GltfReader, The_default_scene_is_read_and_said) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  file.node({{"name", "other"}}, false);
  file.push("scenes", {{"name", "second"}, {"nodes", {1}}});
  EXPECT_EQ(good(file).nodes.at(0).name, "nodes[0]");
  file.json["scene"] = 1;
  const Character c = good(file);
  EXPECT_EQ(c.nodes.at(0).name, "other");
  EXPECT_TRUE(c.meshes.empty());
  EXPECT_TRUE(says(c.notes, "has 2 scenes; scenes[1] \"second\" was read"));
}

TEST(GltfReader, Circles_and_second_parents_and_depths_are_refused) {
  TinyGltf circle = square_with([](TinyGltf&, Json&) {});
  circle.json["nodes"][0]["children"] = {0};
  expect_refused(circle, "is a circle: nodes[0] is below itself");
  TinyGltf two = square_with([](TinyGltf&, Json&) {});
  two.node({{"children", {0}}});
  expect_refused(two, "no tree: nodes[0] has two parents");
  TinyGltf deep;
  for (int i = 0; i < 2000; ++i) deep.node({{"children", {i + 1}}}, i == 0);
  deep.node({}, false);
  expect_refused(deep, "deeper than 1024");
  TinyGltf absent = square_with([](TinyGltf&, Json&) {});
  absent.json["nodes"][0]["children"] = {7};
  expect_refused(absent, "nodes[7], which is not there");
}

TEST(GltfReader, Extensions_that_are_required_and_not_read_are_refused_by_name) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  file.json["extensionsRequired"] = {"KHR_texture_transform", "KHR_materials_unlit", "KHR_mesh_quantization"};
  good(file);
  for (const char* name : {"EXT_mesh_gpu_instancing", "ACME_inflate"}) {
    TinyGltf more = file;
    more.json["extensionsRequired"].push_back(name);
    expect_refused(more, std::string("requires the extension ") + name);
  }
}

TEST(GltfReader, Extensions_in_use_are_listed_and_those_that_move_things_noted) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  file.json["nodes"][0]["name"] = "grass";
  file.json["nodes"][0]["extensions"] = {{"EXT_mesh_gpu_instancing", Json::object()}};
  file.push("materials", {{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  const Character c = good(file);
  EXPECT_TRUE(says(c.notes, "EXT_mesh_gpu_instancing is not evaluated"));
  EXPECT_TRUE(says(c.notes, "nodes[0] \"grass\""));
  EXPECT_FALSE(says(c.notes, "unlit"));
  EXPECT_EQ(std::count_if(c.contents.begin(), c.contents.end(),
                          [](const auto& content) { return content.what.starts_with("extension "); }),
            2);
}

TEST(GltfReader, Nodes_that_the_file_hides_are_marked) {
  TinyGltf file = square_with([](TinyGltf&, Json&) {});
  EXPECT_TRUE(good(file).meshes.at(0).visible);
  file.json["scenes"][0]["nodes"] = {1};
  file.node({{"children", {0}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}}, false);
  EXPECT_FALSE(good(file).meshes.at(0).visible);
}

}  // namespace
}  // namespace ft

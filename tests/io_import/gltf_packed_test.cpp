// Compressed glTF: what the codecs have packed comes out again.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "tests/io_import/tiny_gltf.h"

namespace ft {
namespace {

using namespace test;

TEST(GltfPacked, Meshoptimizers_views_and_filters_are_undone) {
  TinyGltf file;
  const auto packed_view = [&](std::vector<unsigned char> bytes, std::size_t count, std::size_t stride,
                               const char* mode, const char* filter) {
    const int inner = file.view(bytes);
    Json extension = file.json["bufferViews"][static_cast<std::size_t>(inner)];
    extension["count"] = count, extension["byteStride"] = stride, extension["mode"] = mode;
    if (*filter != 0) extension["filter"] = filter;
    Json& view = file.json["bufferViews"][static_cast<std::size_t>(inner)];
    view = {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
    return inner;
  };
  std::vector<float> points;  // a strip of 40 vertices
  std::vector<unsigned> indices;
  for (unsigned v = 0; v < 40; ++v) {
    points.insert(points.end(), {static_cast<float>(v) * 0.37f, static_cast<float>(v % 2), 0.25f});
    if (v >= 2) indices.insert(indices.end(), {v - 2, v - 1, v});
  }
  std::vector<unsigned char> exponents(480), packed(meshopt_encodeVertexBufferBound(40, 12));
  meshopt_encodeFilterExp(exponents.data(), 40, 12, 15, points.data());
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), exponents.data(), 40, 12));
  const int position_view = packed_view(packed, 40, 12, "ATTRIBUTES", "EXPONENTIAL");
  std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(indices.size(), 40));
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
  const int index_view = packed_view(triangles, indices.size(), 2, "TRIANGLES", "");
  const int positions = file.accessor(position_view, 5126, "VEC3", 40);
  const int corners = file.accessor(index_view, 5123, "SCALAR", indices.size());
  file.push("meshes",
            {{"primitives", Json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", corners}}})}});
  file.node({{"mesh", 0}});
  const std::vector<float> turns = {0, 0, 0, 1, 0.6f, 0, 0, 0.8f, 0, 0.28f, 0, 0.96f, 0, 0, 1, 0};
  std::vector<unsigned char> quaternions(32), packed_turns(meshopt_encodeVertexBufferBound(4, 8));
  meshopt_encodeFilterQuat(quaternions.data(), 4, 8, 16, turns.data());
  packed_turns.resize(meshopt_encodeVertexBuffer(packed_turns.data(), packed_turns.size(), quaternions.data(), 4, 8));
  const int turn_view = packed_view(packed_turns, 4, 8, "ATTRIBUTES", "QUATERNION");
  const int rotation = file.accessor(turn_view, 5122, "VEC4", 4, true), times = file.floats({0, 1, 2, 3}, "SCALAR");
  file.push("animations",
            {{"samplers", Json::array({{{"input", times}, {"output", rotation}}})},
             {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}})}});
  file.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const Character c = good(file);
  ASSERT_EQ(c.meshes.size(), 1u);
  ASSERT_EQ(c.meshes[0].positions.size(), 40u);
  for (std::size_t v = 0; v < 40; ++v)
    EXPECT_NEAR(c.meshes[0].positions[v].x(), static_cast<double>(points[3 * v]),
                15 * 0x1p-14);  // 15 bits of the largest
  // The codec turns triangles; their corners stay in order.
  for (std::size_t t = 0; t < c.meshes[0].triangles.size(); ++t) {
    Triangle found = c.meshes[0].triangles[t];
    std::rotate(found.begin(), std::min_element(found.begin(), found.end()), found.end());
    EXPECT_EQ(found, (Triangle{static_cast<int>(t), static_cast<int>(t) + 1, static_cast<int>(t) + 2}));
  }
  const std::vector<double>& keys = c.clips.at(0).channels.at(0).rotation.values;
  for (std::size_t k = 0; k < 4; ++k) {
    double dot = 0;
    for (std::size_t i = 0; i < 4; ++i) dot += keys[4 * k + i] * static_cast<double>(turns[4 * k + i]);
    EXPECT_NEAR(std::abs(dot), 1, 1e-4);
  }
  for (const auto& [key, value] : {std::pair{"count", 1'000'000'000}, {"byteStride", 252}, {"byteLength", 3}}) {
    TinyGltf lie = file;
    lie.json["bufferViews"][static_cast<std::size_t>(position_view)]["extensions"]["EXT_meshopt_compression"][key] =
        value;
    expect_refused(lie, "EXT_meshopt_compression");
  }
}

TEST(GltfPacked, Draco_gives_positions_joints_and_weights) {
  draco::Mesh mesh;
  mesh.set_num_points(4);
  const auto add = [&]<class T>(draco::GeometryAttribute::Type type, draco::DataType kind, int width,
                                const std::vector<T>& values) {
    draco::GeometryAttribute about;
    about.Init(type, nullptr, static_cast<std::int8_t>(width), kind, false,
               static_cast<std::int64_t>(static_cast<std::size_t>(width) * sizeof(T)), 0);
    const int id = mesh.AddAttribute(about, true, 4);
    for (std::uint32_t v = 0; v < 4; ++v)
      mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v),
                                            values.data() + static_cast<std::size_t>(width) * v);
    return static_cast<int>(mesh.attribute(id)->unique_id());
  };
  const int position = add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, test::k_square);
  const int joints = add(draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 4,
                         std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  const int weights = add(draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 4,
                          std::vector<std::uint8_t>{255, 0, 0, 0, 204, 51, 0, 0, 102, 153, 0, 0, 51, 204, 0, 0});
  mesh.AddFace({draco::PointIndex(0), draco::PointIndex(1), draco::PointIndex(2)});
  mesh.AddFace({draco::PointIndex(0), draco::PointIndex(2), draco::PointIndex(3)});
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer packed;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(mesh, &packed).ok());
  TinyGltf file = skinned_square([&](TinyGltf& f, Json& a) { put_weights<std::uint8_t>(f, a, 5121, 255, true); });
  const int view = file.view_of(packed.data(), packed.size());
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", position}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}};
  for (const char* name : {"POSITION", "JOINTS_0", "WEIGHTS_0"})
    file.json["accessors"][primitive["attributes"][name].get<std::size_t>()].erase("bufferView");
  file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const Character c = good(file);
  expect_weights(c, 1e-9);
  EXPECT_EQ(c.meshes.at(0).triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(c.meshes[0].positions[2], Vec3(1, 1, 0));
  file.bin[file.bin.size() - packed.size() + 8] = std::byte{0xff};
  EXPECT_FALSE(file.read());
}

}  // namespace
}  // namespace ft

// Small glTF files for tests: JSON and bytes that grow together.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "baker/core/file.h"
#include "io/import/gltf/gltf_file.h"
#include "io/import/gltf/gltf_read.h"
#include "tests/support/assets.h"

namespace ft::test {

using gltf::Json;

class TinyGltf {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};
  Bytes bin;

  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    return view_of(values.data(), values.size() * sizeof(T), stride);
  }
  int view_of(const void* data, std::size_t size, int stride = 0) {
    while (bin.size() % 16 != 0) bin.push_back(std::byte{0});
    Json about = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", size}};
    if (stride > 0) about["byteStride"] = stride;
    const auto* bytes = static_cast<const std::byte*>(data);
    bin.insert(bin.end(), bytes, bytes + size);
    return push("bufferViews", about);
  }
  /// view -1: none.
  int accessor(int view, int component, const char* type, std::size_t count, bool normalized = false, int offset = 0) {
    Json about = {{"componentType", component}, {"type", type}, {"count", count}};
    if (view >= 0) about["bufferView"] = view;
    if (offset > 0) about["byteOffset"] = offset;
    if (normalized) about["normalized"] = true;
    return push("accessors", about);
  }
  int floats(const std::vector<float>& values, const char* type) {
    const std::string_view kind = type;
    const std::size_t width = kind == "SCALAR" ? 1 : kind == "VEC3" ? 3 : kind == "VEC4" ? 4 : 16;
    return accessor(view(values), 5126, type, values.size() / width);
  }
  int push(const char* list, Json value) {
    if (!json.contains(list)) json[list] = Json::array();
    json[list].push_back(std::move(value));
    return static_cast<int>(json[list].size()) - 1;
  }
  /// A node of the scene, unless it is to be a child.
  int node(Json about, bool root = true) {
    const int index = push("nodes", std::move(about));
    if (root) json["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  Bytes glb() const {
    Json all = json;
    if (!bin.empty()) all["buffers"] = Json::array({{{"byteLength", bin.size()}}});
    std::string text = all.dump();
    while (text.size() % 4 != 0) text.push_back(' ');
    Bytes padded = bin;
    while (padded.size() % 4 != 0) padded.push_back(std::byte{0});
    ByteWriter out;
    const auto size = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
    out.write(0x46546c67u).write(2u).write(size(28 + text.size() + padded.size()));
    out.write(size(text.size())).write(0x4e4f534au).write_raw(text.data(), text.size());
    out.write(size(padded.size())).write(0x004e4942u).write_raw(padded.data(), padded.size());
    return out.take();
  }
  Result<Character> read() const { return read_bytes(glb()); }

  static Result<Character> read_bytes(const Bytes& bytes) {
    const ScratchFolder scratch(ScratchFolder::k_in_memory);
    const auto file = scratch / "tiny.glb";
    EXPECT_TRUE(write_file_durably(file, bytes));
    auto out = read_gltf(file);
    if (out)
      if (Status checked = check_character(*out); !checked) return checked.error();
    return out;
  }
};

inline const std::vector<float> k_square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// A square of two triangles whose attributes the caller gives on top; its mesh has index 0.
inline Json square_primitive(TinyGltf& file) {
  const int positions = file.floats(k_square, "VEC3");
  const int indices = file.accessor(file.view(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}), 5123, "SCALAR", 6);
  return {{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
}

inline bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

inline Character good(const TinyGltf& file) {
  auto out = file.read();
  EXPECT_TRUE(out) << out.error().text();
  return out ? std::move(*out) : Character{};
}

inline void expect_refused(const TinyGltf& file, const std::string& words) {
  auto out = file.read();
  ASSERT_FALSE(out) << words;
  EXPECT_NE(out.error().text().find(words), std::string::npos) << out.error().text();
}

/// The square at a node, with what the test has put into its primitive.
inline TinyGltf square_with(const std::function<void(TinyGltf&, Json& primitive)>& change) {
  TinyGltf file;
  Json primitive = square_primitive(file);
  change(file, primitive);
  file.push("meshes", {{"primitives", Json::array({primitive})}});
  file.node({{"mesh", 0}});
  return file;
}

/// The square on two joints, nodes 1 and 2; joint 2 is 10 up.
inline TinyGltf skinned_square(const std::function<void(TinyGltf&, Json& attributes)>& weights, bool binds = true) {
  TinyGltf file;
  Json primitive = square_primitive(file);
  weights(file, primitive["attributes"]);
  file.push("meshes", {{"primitives", Json::array({primitive})}});
  file.node({{"mesh", 0}, {"skin", 0}});
  file.node({{"name", "low"}});
  file.node({{"name", "high"}, {"translation", {0, 10, 0}}});
  Json skin = {{"joints", {1, 2}}};
  if (binds) {
    std::vector<float> matrices(32, 0);
    for (std::size_t k = 0; k < 32; k += 16)
      for (std::size_t i = 0; i < 4; ++i) matrices[k + 5 * i] = 1;
    matrices[16 + 13] = -10;
    skin["inverseBindMatrices"] = file.floats(matrices, "MAT4");
  }
  file.push("skins", skin);
  return file;
}

template <class T>
void put_weights(TinyGltf& file, Json& attributes, int component, double one, bool normalized) {
  std::vector<T> weights;
  const auto round = [&](double share) { return std::is_integral_v<T> ? std::round(share * one) : share * one; };
  for (const double share : {1.0, 0.8, 0.4, 0.2}) {
    weights.push_back(static_cast<T>(round(share))), weights.push_back(static_cast<T>(round(1 - share)));
    weights.push_back(0), weights.push_back(0);
  }
  attributes["WEIGHTS_0"] = file.accessor(file.view(weights), component, "VEC4", 4, normalized);
  attributes["JOINTS_0"] = file.accessor(
      file.view(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 5121, "VEC4", 4);
}

inline void expect_weights(const Character& c, double tolerance) {
  ASSERT_EQ(c.meshes.size(), 1u);
  const CharacterMesh& mesh = c.meshes[0];
  ASSERT_EQ(mesh.influence_start, (std::vector<int>{0, 1, 3, 5, 7}));
  const double expected[] = {1, 0.8, 0.2, 0.4, 0.6, 0.2, 0.8};
  for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(mesh.influence_weight[k], expected[k], tolerance);
}

}  // namespace ft::test

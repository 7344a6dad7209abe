// A character of boxes with two legs and flat soles, as a GLB: what stands, lands and sinks by closed forms.
#pragma once

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::test {

struct HipsKey {
  double time = 0, height = 0;  ///< s; m above where it stands with its soles at 0
};

/// Nodes Hips, LeftUpLeg, LeftLeg, LeftFoot and the right ones; one clip "motion" of the hips.
inline void write_block_person(const std::filesystem::path& path, const std::vector<HipsKey>& keys) {
  std::string bytes, views, accessors;
  int count = 0;
  const auto add = [&](const void* data, std::size_t size, int elements, const std::string& rest) {
    const std::string comma = count > 0 ? "," : "";
    views += comma + R"({"buffer":0,"byteOffset":)" + std::to_string(bytes.size()) + R"(,"byteLength":)" +
             std::to_string(size) + "}";
    accessors += comma + R"({"bufferView":)" + std::to_string(count) + R"(,"count":)" + std::to_string(elements) + "," +
                 rest + "}";
    bytes.append(static_cast<const char*>(data), size);
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return count++;
  };
  const std::array<Vec3, 7> joints{Vec3(0, 1, 0),  {0.1, 0.9, 0},     {0.1, 0.5, 0.02}, {0.1, 0.1, 0},
                                   {-0.1, 0.9, 0}, {-0.1, 0.5, 0.02}, {-0.1, 0.1, 0}};
  const std::array<Vec3, 7> centres{Vec3(0, 1.3, 0), {0.1, 0.7, 0},  {0.1, 0.3, 0},     {0.1, 0.05, 0.05},
                                    {-0.1, 0.7, 0},  {-0.1, 0.3, 0}, {-0.1, 0.05, 0.05}};
  const std::array<Vec3, 4> halves{Vec3(0.2, 0.35, 0.15), {0.07, 0.2, 0.07}, {0.06, 0.19, 0.06}, {0.05, 0.05, 0.13}};
  std::vector<float> positions, weights, binds, times, places;
  std::vector<std::uint8_t> bones;
  std::vector<std::uint16_t> indices;
  const int sides[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (std::size_t b = 0; b < joints.size(); ++b) {
    const Vec3& half = halves[b > 3 ? b - 3 : b];
    for (const auto& side : sides)
      for (const int corner : side)
        indices.push_back(static_cast<std::uint16_t>(8 * b + static_cast<std::size_t>(corner)));
    for (int c = 0; c < 8; ++c) {
      const Vec3 x = centres[b] + half.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1));
      for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(x[k]));
      for (int k = 0; k < 4; ++k) bones.push_back(k == 0 ? static_cast<std::uint8_t>(b) : 0), weights.push_back(k == 0);
    }
    Eigen::Matrix4f bind = Eigen::Matrix4f::Identity();
    bind.topRightCorner<3, 1>() = -joints[b].cast<float>();
    binds.insert(binds.end(), bind.data(), bind.data() + 16);
  }
  for (const HipsKey& key : keys) {
    times.push_back(static_cast<float>(key.time));
    places.insert(places.end(), {0, static_cast<float>(1 + key.height), 0});
  }
  const int n = static_cast<int>(8 * joints.size()), key_count = static_cast<int>(keys.size());
  add(positions.data(), 4 * positions.size(), n,
      R"("componentType":5126,"type":"VEC3","min":[-1,-1,-1],"max":[2,2,2])");
  add(bones.data(), bones.size(), n, R"("componentType":5121,"type":"VEC4")");
  add(weights.data(), 4 * weights.size(), n, R"("componentType":5126,"type":"VEC4")");
  add(indices.data(), 2 * indices.size(), static_cast<int>(indices.size()), R"("componentType":5123,"type":"SCALAR")");
  add(binds.data(), 4 * binds.size(), 7, R"("componentType":5126,"type":"MAT4")");
  add(times.data(), 4 * times.size(), key_count,
      R"("componentType":5126,"type":"SCALAR","min":[0],"max":[)" + std::to_string(keys.back().time) + "]");
  add(places.data(), 4 * places.size(), key_count, R"("componentType":5126,"type":"VEC3")");

  const char* names[] = {"Hips", "LeftUpLeg", "LeftLeg", "LeftFoot", "RightUpLeg", "RightLeg", "RightFoot"};
  std::string nodes;
  for (std::size_t b = 0; b < joints.size(); ++b) {
    const Vec3 local = b == 0 ? joints[0] : Vec3(joints[b] - joints[b == 1 || b == 4 ? 0 : b - 1]);
    nodes += std::string(R"({"name":")") + names[b] + R"(","translation":[)" + std::to_string(local.x()) + "," +
             std::to_string(local.y()) + "," + std::to_string(local.z()) + "]";
    if (b == 0) nodes += R"(,"children":[1,4])";
    if (b == 1 || b == 2 || b == 4 || b == 5) nodes += R"(,"children":[)" + std::to_string(b + 1) + "]";
    nodes += "},";
  }
  std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,7]}],"nodes":[)" + nodes +
                     R"({"name":"Body","mesh":0,"skin":0}],"skins":[{"joints":[0,1,2,3,4,5,6],)"
                     R"("inverseBindMatrices":4}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,)"
                     R"("WEIGHTS_0":2},"indices":3}]}],"animations":[{"name":"motion","samplers":[{"input":5,)"
                     R"("output":6}],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}],)"
                     R"("buffers":[{"byteLength":)" +
                     std::to_string(bytes.size()) + R"(}],"bufferViews":[)" + views + R"(],"accessors":[)" + accessors +
                     "]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::ofstream out(path, std::ios::binary);
  const auto number = [&](std::uint32_t v) { out.write(reinterpret_cast<const char*>(&v), 4); };
  const auto json_size = static_cast<std::uint32_t>(json.size()), size = static_cast<std::uint32_t>(bytes.size());
  for (const std::uint32_t v : {0x46546C67u, 2u, 28 + json_size + size, json_size, 0x4E4F534Au}) number(v);
  out << json;
  number(size), number(0x004E4942u);
  out << bytes;
}

}  // namespace ft::test

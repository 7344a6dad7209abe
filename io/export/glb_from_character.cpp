#include "io/export/glb_from_character.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "io/export/glb_bytes.h"
#include "io/import/character/motion_change.h"
#include "io/import/character/plain_clip.h"
#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

using gltf::Json;

Json numbers(std::span<const double> values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(v);
  return out;
}

Mat4 in_metres(Mat4 m, double unit) {
  m.topRightCorner<3, 1>() *= unit;
  return m;
}

/// What moves has no matrix; all else keeps one that is sheared.
Json node_json(const CharacterNode& node, double unit, bool moves) {
  const Mat4 local = in_metres(node.local, unit);
  const NodeTransform parts = decompose(local);
  const Vec3 scale = parts.stretch.diagonal();
  Json out = {{"name", node.name}};
  if (!moves && (parts.stretch - Mat3(scale.asDiagonal())).cwiseAbs().maxCoeff() > 1e-9 * scale.cwiseAbs().maxCoeff()) {
    out["matrix"] = numbers({local.data(), 16});
    return out;
  }
  out["translation"] = numbers({parts.translation.data(), 3});
  out["rotation"] = numbers({parts.rotation.coeffs().data(), 4});
  out["scale"] = numbers({scale.data(), 3});
  return out;
}

void add_track(Json& json, Json& animation, Bytes& bin, std::size_t node, const char* path, const Track& track,
               double unit) {
  if (track.empty()) return;
  std::vector<double> values = track.values;
  for (double& v : values) v *= unit;
  const std::size_t input = add_accessor(json, bin, track.times, 1, true);
  const std::size_t output = add_accessor(json, bin, values, track.width, false);
  const char* how = track.interpolation == KeyInterpolation::k_step    ? "STEP"
                    : track.interpolation == KeyInterpolation::k_cubic ? "CUBICSPLINE"
                                                                       : "LINEAR";
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back({{"input", input}, {"interpolation", how}, {"output", output}});
}

}  // namespace

Result<Bytes> glb_from_character(const Character& character, int clip, const Mat4& placement,
                                 std::vector<std::string>& notes) {
  if (clip < 0 || at(clip) >= character.clips.size())
    return usage_error("clip " + std::to_string(clip) + " does not exist");
  if (Status s = check_character(character); !s) return s.error();
  const Mat3 linear = placement.topLeftCorner<3, 3>();
  const double unit = std::cbrt(linear.determinant());
  const Mat3 axes = linear / unit;
  if (!(unit > 0) || !((axes.transpose() * axes - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-9))
    return usage_error("units and axes are no scale and rotation");
  const bool turned = (axes - Mat3::Identity()).cwiseAbs().maxCoeff() > 1e-9;

  const Clip moved_by = plain_clip(character, character.clips[at(clip)], notes);
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "followthrough"}}}, {"scene", 0}};
  Json& nodes = json["nodes"] = Json::array();
  Json roots = Json::array();
  for (std::size_t i = 0; i < character.nodes.size(); ++i) {
    nodes.push_back(node_json(character.nodes[i], unit, find_channel(moved_by, static_cast<int>(i)) != nullptr));
    const int parent = character.nodes[i].parent;
    if (parent < 0)
      roots.push_back(i);
    else
      nodes[at(parent)]["children"].push_back(i);
  }
  if (turned) {
    const Quat q(axes);
    nodes.push_back({{"name", "axes"}, {"rotation", numbers({q.coeffs().data(), 4})}, {"children", roots}});
    roots = Json::array({nodes.size() - 1});
  }
  json["scenes"] = Json::array({Json{{"nodes", roots}}});

  Bytes bin;
  Json animation = {{"name", moved_by.name}, {"channels", Json::array()}, {"samplers", Json::array()}};
  std::vector<char> bone(character.nodes.size(), 0);
  for (const CharacterMesh& mesh : character.meshes)
    for (const SkinBone& b : mesh.bones) bone[at(b.node)] = 1;
  for (const Channel& channel : moved_by.channels) {
    const std::size_t node = at(channel.node);
    bone[node] = 1;
    add_track(json, animation, bin, node, "translation", channel.translation, unit);
    add_track(json, animation, bin, node, "rotation", channel.rotation, 1);
    add_track(json, animation, bin, node, "scale", channel.scale, 1);
  }
  Json joints = Json::array();
  for (std::size_t i = 0; i < bone.size(); ++i)
    if (bone[i]) joints.push_back(i);
  if (!joints.empty()) json["skins"] = Json::array({Json{{"joints", joints}}});
  json["animations"] = Json::array({std::move(animation)});
  json["buffers"] = Json::array({Json{{"byteLength", bin.size()}}});
  return glb_bytes(json, bin);
}

}  // namespace ft::inline io

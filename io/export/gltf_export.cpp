#include "io/export/gltf_export.h"

#include <algorithm>
#include <cmath>

#include "baker/core/file.h"
#include "io/export/glb_bytes.h"
#include "io/import/character/pose.h"
#include "io/import/gltf/gltf_nodes.h"

namespace ft::inline io {
namespace {

using gltf::element, gltf::integer, gltf::Json, gltf::member, gltf::text;

const char* path_name(ChannelPath path) {
  return path == ChannelPath::k_translation ? "translation" : path == ChannelPath::k_rotation ? "rotation" : "scale";
}

/// Points a bufferView, or an extension of it that names a buffer, to where that buffer begins in the one of the .glb.
Status move_view(Json& view, const std::vector<std::size_t>& begin) {
  const std::int64_t buffer = integer(member(view, "buffer"), -1), offset = integer(member(view, "byteOffset"), 0);
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= begin.size() || offset < 0)
    return input_error("a bufferView has no buffer");
  const std::size_t moved = begin[static_cast<std::size_t>(buffer)] + static_cast<std::size_t>(offset);
  if (buffer == 0 && begin[0] == 0) return {};
  view["buffer"] = 0;
  view["byteOffset"] = moved;
  return {};
}

/// All buffers as one. The .glb's own stays first, as it is.
Status join_buffers(gltf::GltfFile& file, Json& json, Bytes& bin) {
  std::vector<std::size_t> begin;
  const std::size_t count = member(json, "buffers").is_array() ? json["buffers"].size() : 0;
  for (std::size_t b = 0; b < count; ++b) {
    const std::string where = "buffer " + std::to_string(b);
    const Json& about = json["buffers"][b];
    const std::int64_t length = integer(member(about, "byteLength"), -1);
    if (b > 0 && text(member(about, "uri")).empty()) return input_error("has no uri and is not the first", where);
    auto bytes = file.buffer(static_cast<std::int64_t>(b));
    if (!bytes) return bytes.error();
    if (length < 0 || (*bytes)->size() < static_cast<std::uint64_t>(length))
      return input_error(
          "has " + std::to_string((*bytes)->size()) + " bytes of the " + std::to_string(length) + " that the file says",
          where);
    begin.push_back(append_aligned(bin, std::span(**bytes).first(static_cast<std::size_t>(length))));
  }
  if (member(json, "bufferViews").is_array())
    for (Json& view : json["bufferViews"]) {
      if (Status s = move_view(view, begin); !s) return s;
      if (!member(view, "extensions").is_object()) continue;
      for (auto& extension : view["extensions"])
        if (member(extension, "buffer").is_number())
          if (Status s = move_view(extension, begin); !s) return s;
    }
  Json only = count > 0 ? json["buffers"][0] : Json::object();
  only.erase("uri");
  json["buffers"] = Json::array({std::move(only)});
  return {};
}

void embed_images(const gltf::GltfFile& file, Json& json, Bytes& bin) {
  if (!member(json, "images").is_array()) return;
  for (std::size_t i = 0; i < json["images"].size(); ++i) {
    const Json& found = json["images"][i];
    const std::string uri = text(member(found, "uri"));
    std::string ending = std::filesystem::path(uri).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    const bool png = ending == ".png", jpeg = ending == ".jpg" || ending == ".jpeg";
    if (uri.starts_with("data:") || (!png && !jpeg)) continue;
    const auto bytes = read_file(file.folder() / gltf::decode_percent(uri));
    if (!bytes) continue;
    const std::size_t view = add_view(json, bin, *bytes);  // a key that the file lacks moves all others
    Json& image = json["images"][i];
    image.erase("uri");
    image["mimeType"] = png ? "image/png" : "image/jpeg";
    image["bufferView"] = view;
  }
}

/// A node that moves has no matrix.
Status split_matrix(Json& node, const Mat4& local) {
  if (!node.contains("matrix")) return {};
  const NodeTransform parts = decompose(local);
  const Mat3 scale = parts.stretch.diagonal().asDiagonal();
  if ((parts.stretch - scale).cwiseAbs().maxCoeff() > 1e-6 * scale.cwiseAbs().maxCoeff())
    return input_error("is sheared: its matrix is no translation, rotation and scale");
  Json out = Json::object();
  for (const auto& [key, value] : node.items()) {
    if (key != "matrix") {
      out[key] = value;
      continue;
    }
    const Quat& q = parts.rotation;
    out["translation"] = {parts.translation.x(), parts.translation.y(), parts.translation.z()};
    out["rotation"] = {q.x(), q.y(), q.z(), q.w()};
    out["scale"] = {scale(0, 0), scale(1, 1), scale(2, 2)};
  }
  node = std::move(out);
  return {};
}

/// Index of a node's channel for a path, the last one if there are several; -1 when there is none.
int find_json_channel(const Json& animation, int node, const char* path) {
  const Json& channels = member(animation, "channels");
  for (std::size_t c = channels.is_array() ? channels.size() : 0; c-- > 0;) {
    const Json& target = member(channels[c], "target");
    if (integer(member(target, "node"), -1) == node && text(member(target, "path")) == path) return static_cast<int>(c);
  }
  return -1;
}

/// The accessor of the old sampler when the new keys have the same times, else a new one.
std::size_t time_accessor(gltf::GltfFile& file, Json& json, Bytes& bin, const Json& old_sampler, const Track& track) {
  const std::int64_t old = integer(member(old_sampler, "input"), -1);
  int width = 0;
  if (old >= 0)
    if (const auto times = file.accessor(old, width); times && width == 1)
      if (std::equal(times.value().begin(), times.value().end(), track.times.begin(), track.times.end(),
                     [](double a, double b) { return static_cast<float>(a) == static_cast<float>(b); }))
        return static_cast<std::size_t>(old);
  return add_accessor(json, bin, track.times, 1, true);
}

Status change_channel(gltf::GltfFile& file, Json& json, Bytes& bin, int clip, int node, const ChangedChannel& change) {
  const Json& before = json["animations"][at(clip)];
  for (const char* key : {"channels", "samplers"})
    if (!member(before, key).is_array()) return input_error("an animation has no channels or samplers");
  const char* path = path_name(change.path);
  const int found = find_json_channel(before, node, path);
  std::int64_t sampler = -1, users = 0;
  if (found >= 0) {
    sampler = integer(member(before["channels"][at(found)], "sampler"), -1);
    for (const Json& channel : before["channels"]) users += integer(member(channel, "sampler"), -1) == sampler;
  }
  const Json old = element(before["samplers"], sampler);
  if (found >= 0 && !old.is_object()) return input_error("a channel's sampler does not exist");
  Json next = found >= 0 ? old : Json{{"input", 0}, {"interpolation", "LINEAR"}, {"output", 0}};
  const Track& track = change.track;
  next["input"] = time_accessor(file, json, bin, old, track);
  next["output"] = add_accessor(json, bin, track.values, track.width, false);
  if (track.interpolation != KeyInterpolation::k_linear || next.contains("interpolation"))
    next["interpolation"] = track.interpolation == KeyInterpolation::k_step    ? "STEP"
                            : track.interpolation == KeyInterpolation::k_cubic ? "CUBICSPLINE"
                                                                               : "LINEAR";
  Json& animation = json["animations"][at(clip)];  // anew: an accessor may be the first, and a new key moves all others
  if (users == 1) {
    animation["samplers"][static_cast<std::size_t>(sampler)] = std::move(next);
    return {};
  }
  animation["samplers"].push_back(std::move(next));
  const std::size_t added = animation["samplers"].size() - 1;
  if (found >= 0)
    animation["channels"][at(found)]["sampler"] = added;
  else
    animation["channels"].push_back({{"sampler", added}, {"target", {{"node", node}, {"path", path}}}});
  return {};
}

Result<Bytes> write_changed(gltf::GltfFile& file, const Character& character, int clip,
                            std::span<const ChangedChannel> changes) {
  Json json = file.json();
  Bytes bin;
  if (Status s = join_buffers(file, json, bin); !s) return s.error();
  embed_images(file, json, bin);
  if (!changes.empty()) {
    const std::vector<int> character_node = gltf::match_nodes(json, character);
    if (character_node.empty()) return input_error("its nodes are not those of the imported character");
    if (!member(json, "animations").is_array() || json["animations"].size() != character.clips.size())
      return input_error("its animations are not the clips of the imported character");
    for (const ChangedChannel& change : changes) {
      const auto found = std::find(character_node.begin(), character_node.end(), change.node);
      const std::string name = "node \"" + character.nodes[at(change.node)].name + "\"";
      if (found == character_node.end()) return input_error("is not in the file", name);
      const auto node = static_cast<std::size_t>(found - character_node.begin());
      Status s = split_matrix(json["nodes"][node], character.nodes[at(change.node)].local);
      if (s) s = change_channel(file, json, bin, clip, static_cast<int>(node), change);
      if (!s) return input_error(s.error().what, name);
    }
  }
  return glb_bytes(json, bin, file.further_chunks());
}

}  // namespace

Result<Bytes> export_glb(const std::filesystem::path& source, const Character& character, int clip,
                         std::span<const ChangedChannel> changes) {
  if (!changes.empty())
    if (Status s = check_changes(character, clip, changes); !s) return s.error();
  auto original = read_file(source);
  if (!original) return original.error();
  auto file = gltf::GltfFile::open(source);
  if (!file) return input_error(file.error().what, source.string());
  constexpr std::string_view k_magic = "glTF";
  const bool binary = original->size() >= 4 && std::memcmp(original->data(), k_magic.data(), 4) == 0;
  if (changes.empty() && binary) return std::move(*original);
  try {
    auto out = write_changed(*file, character, clip, changes);
    if (!out)
      return input_error(out.error().what,
                         source.string() + (out.error().where.empty() ? "" : ", " + out.error().where));
    return out;
  } catch (const Json::exception& e) {
    return input_error(std::string("glTF's JSON contradicts itself: ") + e.what(), source.string());
  }
}

}  // namespace ft::inline io

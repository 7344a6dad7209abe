#include "io/import/files/gltf_clips.h"

#include <cmath>

#include "io/import/files/gltf_file.h"

namespace ft::inline io {
namespace {

using gltf::element, gltf::integer, gltf::Json, gltf::member, gltf::numbers, gltf::text;

/// A channel that moves a part of a node leaves the other parts as the JSON has them (scale may hold a reflection that
/// cannot be told from a rotation once it is in a matrix).
void fill_rest(const Json& node, Channel& channel) {
  if (node.contains("matrix")) return;
  double first = std::numeric_limits<double>::infinity();  // constant keys do not lengthen the clip
  for (const Track* t : {&channel.translation, &channel.rotation, &channel.scale})
    if (!t->empty()) first = std::min(first, t->times.front());
  const auto fill = [&](Track& track, const char* key, std::vector<double> otherwise) {
    if (!track.empty()) return;
    std::vector<double> value = numbers(member(node, key));
    if (value.size() != otherwise.size()) value = std::move(otherwise);
    track.width = static_cast<int>(value.size());
    track.times = {first};
    track.values = std::move(value);
  };
  fill(channel.translation, "translation", {0, 0, 0});
  fill(channel.rotation, "rotation", {0, 0, 0, 1});
  fill(channel.scale, "scale", {1, 1, 1});
}

Result<Track> read_sampler(gltf::GltfFile& file, const Json& sampler, int width) {
  Track track;
  int time_width = 0, value_width = 0;
  auto times = file.accessor(integer(member(sampler, "input"), -1), time_width);
  if (!times) return times.error();
  auto values = file.accessor(integer(member(sampler, "output"), -1), value_width);
  if (!values) return values.error();
  const std::string how = text(member(sampler, "interpolation"));
  track.interpolation = how == "STEP"          ? KeyInterpolation::k_step
                        : how == "CUBICSPLINE" ? KeyInterpolation::k_cubic
                                               : KeyInterpolation::k_linear;
  track.times = std::move(*times);
  track.values = std::move(*values);
  const std::size_t per_key = track.interpolation == KeyInterpolation::k_cubic ? 3 : 1;
  if (width == 0 && !track.times.empty()) width = static_cast<int>(track.values.size() / track.times.size() / per_key);
  track.width = width;
  if (time_width != 1 || width == 0 || (width == 3 && value_width != 3 && value_width != 1) ||
      track.values.size() != track.times.size() * track.stride())
    return input_error("a sampler's keys and values do not match");
  for (std::size_t i = 1; i < track.times.size(); ++i)
    if (!(track.times[i] > track.times[i - 1])) return input_error("key times do not ascend");
  return track;
}

Result<std::vector<Clip>> read_clips(gltf::GltfFile& file, const std::vector<int>& node_of,
                                     const Character& character) {
  std::vector<Clip> clips;
  const Json& animations = member(file.json(), "animations");
  for (std::size_t a = 0; animations.is_array() && a < animations.size(); ++a) {
    Clip clip;
    clip.name = text(member(animations[a], "name"));
    if (clip.name.empty()) clip.name = "animation_" + std::to_string(a);
    std::vector<Channel> of_node(character.nodes.size());
    const Json& channels = member(animations[a], "channels");
    for (std::size_t c = 0; channels.is_array() && c < channels.size(); ++c) {
      const Json& target = member(channels[c], "target");
      const std::int64_t node = integer(member(target, "node"), -1);
      const std::string path = text(member(target, "path"));
      if (node < 0 || static_cast<std::size_t>(node) >= node_of.size() || node_of[static_cast<std::size_t>(node)] < 0)
        continue;
      Channel& channel = of_node[static_cast<std::size_t>(node_of[static_cast<std::size_t>(node)])];
      Track* track = path == "translation" ? &channel.translation
                     : path == "rotation"  ? &channel.rotation
                     : path == "scale"     ? &channel.scale
                     : path == "weights"   ? &channel.weights
                                           : nullptr;
      if (track == nullptr) continue;
      const int width = path == "weights" ? 0 : path == "rotation" ? 4 : 3;
      auto read = read_sampler(
          file, element(member(animations[a], "samplers"), integer(member(channels[c], "sampler"), -1)), width);
      if (!read) return read.error();
      *track = std::move(*read);
      channel.node = static_cast<int>(node);  // of the JSON, until the rest is filled in
    }
    for (std::size_t n = 0; n < of_node.size(); ++n) {
      Channel& channel = of_node[n];
      if (channel.node < 0) continue;
      if (!channel.translation.empty() || !channel.rotation.empty() || !channel.scale.empty())
        fill_rest(element(member(file.json(), "nodes"), channel.node), channel);
      channel.node = static_cast<int>(n);
      clip.channels.push_back(std::move(channel));
    }
    clip.find_range();
    clips.push_back(std::move(clip));
  }
  return clips;
}

void read_rest_weights(const Json& json, const std::vector<int>& node_of, Character& character) {
  for (std::size_t n = 0; n < node_of.size(); ++n) {
    if (node_of[n] < 0) continue;
    const Json& node = element(member(json, "nodes"), static_cast<std::int64_t>(n));
    std::vector<double> weights = numbers(member(node, "weights"));
    if (weights.empty())
      weights = numbers(member(element(member(json, "meshes"), integer(member(node, "mesh"), -1)), "weights"));
    auto& rest = character.nodes[static_cast<std::size_t>(node_of[n])].morph_weights;
    for (std::size_t k = 0; k < rest.size() && k < weights.size(); ++k) rest[k] = weights[k];
  }
}

}  // namespace

void read_gltf_clips(const std::filesystem::path& path, Character& character) {
  const char* doubt = "; keys are joined by straight lines, steps and splines in the file may be lost";
  try {
    auto file = gltf::GltfFile::open(path);
    if (!file) return character.notes.push_back("animation read by assimp: " + file.error().what + doubt);
    const std::vector<int> node_of = gltf::match_nodes(file->json(), character);
    if (node_of.empty())
      return character.notes.push_back(std::string("animation read by assimp: node trees differ") + doubt);
    read_rest_weights(file->json(), node_of, character);
    auto clips = read_clips(*file, node_of, character);
    if (!clips) return character.notes.push_back("animation read by assimp: " + clips.error().what + doubt);
    character.clips = std::move(*clips);
  } catch (const std::exception& e) {
    character.notes.push_back(std::string("animation read by assimp: ") + e.what() + doubt);
  }
}

}  // namespace ft::inline io

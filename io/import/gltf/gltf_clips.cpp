// Channels of animations. KHR_animation_pointer is followed where it points to what a plain channel can move.
#include "io/import/gltf/gltf_clips.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace ft::inline io::gltf {
namespace {

/// How much was read of all clips, and what was odd; the latter becomes notes.
struct ClipOddities {
  std::size_t numbers_read = 0;
  int dropped_keys = 0, empty_channels = 0, doubled = 0, pointers = 0, wrong_weights = 0, uneven = 0;
  std::string first_pointer;
};

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

/// Keys that are not later than the one before go.
void drop_late_keys(Track& track, int& dropped) {
  const std::size_t stride = track.stride();
  std::size_t kept = 1;
  for (std::size_t i = 1; i < track.times.size(); ++i) {
    if (track.times[i] <= track.times[kept - 1]) {  // NaN passes here and is refused by the check
      ++dropped;
      continue;
    }
    if (kept != i) {
      track.times[kept] = track.times[i];
      std::copy_n(track.values.begin() + static_cast<std::ptrdiff_t>(i * stride), stride,
                  track.values.begin() + static_cast<std::ptrdiff_t>(kept * stride));
    }
    ++kept;
  }
  track.times.resize(kept), track.values.resize(kept * stride);
}

/// Rotations that the file says in floats and whose length is not 1 (those in few bits never have it exactly).
int uneven_rotations(const Track& track) {
  const std::size_t first = track.interpolation == KeyInterpolation::k_cubic ? 4 : 0;
  int count = 0;
  for (std::size_t k = first; k + 4 <= track.values.size(); k += track.stride()) {
    const double* q = track.values.data() + k;
    count += std::abs(std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) - 1) > 1e-4;
  }
  return count;
}

/// width 0: as many as the values give (morph weights).
Result<Track> read_sampler(GltfFile& file, const Json& sampler, int width, ClipOddities& odd) {
  Track track;
  auto times = file.read(integer(member(sampler, "input"), -1), Integers::k_fractions);
  if (!times) return input_error("key times: " + times.error().what);
  auto values = file.read(integer(member(sampler, "output"), -1), Integers::k_fractions);
  if (!values) return input_error("key values: " + values.error().what);
  const std::string how = sampler.contains("interpolation") ? text(member(sampler, "interpolation")) : "LINEAR";
  if (how != "STEP" && how != "CUBICSPLINE" && how != "LINEAR")
    return input_error("has the unknown interpolation \"" + how + "\"");
  track.interpolation = how == "STEP"          ? KeyInterpolation::k_step
                        : how == "CUBICSPLINE" ? KeyInterpolation::k_cubic
                                               : KeyInterpolation::k_linear;
  track.times = std::move(times->values);
  track.values = std::move(values->values);
  if (track.times.empty() && track.values.empty()) return track;
  const std::size_t per_key = track.interpolation == KeyInterpolation::k_cubic ? 3 : 1;
  const bool morphs = width == 0;
  if (morphs && !track.times.empty()) width = static_cast<int>(track.values.size() / track.times.size() / per_key);
  track.width = width;
  if (times->width != 1 || width == 0 || (values->width != width && values->width != 1) ||
      track.values.size() != track.times.size() * track.stride())
    return input_error("has " + std::to_string(track.times.size()) + " key times and " +
                       std::to_string(track.values.size()) + " numbers in its key values, which do not match");
  drop_late_keys(track, odd.dropped_keys);
  const Json& output = element(member(file.json(), "accessors"), integer(member(sampler, "output"), -1));
  if (width == 4 && !morphs && integer(member(output, "componentType"), 0) == 5126)
    odd.uneven += uneven_rotations(track);
  return track;
}

struct Target {
  std::int64_t node = -1;
  std::string path;
};

/// "/nodes/3/rotation" of KHR_animation_pointer as a plain target; node -1 for others.
Target follow_pointer(const std::string& pointer) {
  constexpr std::string_view k_nodes = "/nodes/";
  Target out;
  if (!pointer.starts_with(k_nodes)) return out;
  const char *begin = pointer.data() + k_nodes.size(), *end = pointer.data() + pointer.size();
  const auto [stop, failed] = std::from_chars(begin, end, out.node);
  if (failed != std::errc() || stop == end || *stop != '/') return {};
  out.path = std::string(stop + 1, end);
  for (const char* known : {"translation", "rotation", "scale", "weights"})
    if (out.path == known) return out;
  return {};
}

/// Whether a pointer can only change how things look.
bool moves_nothing(const std::string& pointer) {
  for (const char* start : {"/materials/", "/textures/", "/images/", "/cameras/", "/extensions/KHR_lights_punctual/"})
    if (pointer.starts_with(start)) return true;
  return false;
}

Target target_of(const Json& channel, ClipOddities& odd) {
  const Json& target = member(channel, "target");
  Target out{integer(member(target, "node"), -1), text(member(target, "path"))};
  if (out.path != "pointer") return out;
  const std::string pointer = text(member(member(member(target, "extensions"), "KHR_animation_pointer"), "pointer"));
  out = follow_pointer(pointer);
  if (out.node < 0 && !moves_nothing(pointer) && odd.pointers++ == 0) odd.first_pointer = pointer.substr(0, 80);
  return out;
}

Status read_clip(GltfFile& file, const Json& animation, const std::vector<int>& node_of, const Character& character,
                 Clip& clip, ClipOddities& odd) {
  std::vector<Channel> of_node(character.nodes.size());
  const Json& channels = member(animation, "channels");
  for (std::size_t c = 0; c < size_of_array(channels); ++c) {
    const Target target = target_of(channels[c], odd);
    if (target.node < 0 || static_cast<std::size_t>(target.node) >= node_of.size()) continue;
    const int node = node_of[static_cast<std::size_t>(target.node)];
    if (node < 0) continue;
    Channel& channel = of_node[static_cast<std::size_t>(node)];
    Track* track = target.path == "translation" ? &channel.translation
                   : target.path == "rotation"  ? &channel.rotation
                   : target.path == "scale"     ? &channel.scale
                   : target.path == "weights"   ? &channel.weights
                                                : nullptr;
    if (track == nullptr) continue;
    const std::size_t morphs = character.nodes[static_cast<std::size_t>(node)].morph_weights.size();
    const bool weights = track == &channel.weights;
    if (weights && morphs == 0) continue;
    const int width = weights ? 0 : target.path == "rotation" ? 4 : 3;
    const std::string name =
        "channels[" + std::to_string(c) + "] (" + target.path + " of " + named(file.json(), "nodes", target.node) + ")";
    const Json& sampler = element(member(animation, "samplers"), integer(member(channels[c], "sampler"), -1));
    if (!sampler.is_object()) return input_error(name + " has no sampler");
    auto read = read_sampler(file, sampler, width, odd);
    if (!read) return input_error(name + ": " + read.error().what);
    if (read->empty()) {
      ++odd.empty_channels;
      continue;
    }
    odd.numbers_read += read->values.size() + read->times.size();
    if (odd.numbers_read > k_max_character_keys) return input_error("has more than 200 million numbers in its keys");
    if (weights && static_cast<std::size_t>(read->width) != morphs) ++odd.wrong_weights;
    if (!track->empty()) ++odd.doubled;
    *track = std::move(*read);
    channel.node = static_cast<int>(target.node);  // of the JSON, until the rest is filled in
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
  return {};
}

void add_notes(const ClipOddities& odd, std::vector<std::string>& notes) {
  const auto count = [&](int n, const std::string& what) {
    if (n > 0) notes.push_back(std::to_string(n) + " " + what);
  };
  count(odd.dropped_keys, "keys were not later than the one before; dropped");
  count(odd.uneven, "rotation keys are not of length 1; made so");
  count(odd.empty_channels, "animation channels have no keys; left out");
  count(odd.doubled, "animation channels move what another channel of their clip moves; the last one counts");
  count(
      odd.wrong_weights,
      "animation channels have more or fewer weights than their mesh has morph targets; those beyond are left out, and "
      "targets without one keep their rest weight");
  count(odd.pointers, "animation channels move what is not animated here (KHR_animation_pointer, the first is \"" +
                          odd.first_pointer + "\"); left out");
}

}  // namespace

Status read_clips(GltfFile& file, const std::vector<int>& node_of, Character& out) {
  ClipOddities odd;
  const Json& animations = member(file.json(), "animations");
  for (std::size_t a = 0; a < size_of_array(animations); ++a) {
    Clip clip;
    clip.name = text(member(animations[a], "name"));
    if (clip.name.empty()) clip.name = "animation_" + std::to_string(a);
    if (Status s = read_clip(file, animations[a], node_of, out, clip, odd); !s)
      return input_error(named(file.json(), "animations", static_cast<std::int64_t>(a)) + ", " + s.error().what);
    out.clips.push_back(std::move(clip));
  }
  add_notes(odd, out.notes);
  return {};
}

}  // namespace ft::inline io::gltf

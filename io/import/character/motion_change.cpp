#include "io/import/character/motion_change.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io {

double round_to_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

Track& track_of(Channel& channel, ChannelPath path) {
  return path == ChannelPath::k_translation ? channel.translation
         : path == ChannelPath::k_rotation  ? channel.rotation
                                            : channel.scale;
}

const Track& track_of(const Channel& channel, ChannelPath path) {
  return track_of(const_cast<Channel&>(channel), path);
}

const Channel* find_channel(const Clip& clip, int node) {
  const auto found =
      std::find_if(clip.channels.begin(), clip.channels.end(), [&](const Channel& c) { return c.node == node; });
  return found == clip.channels.end() ? nullptr : &*found;
}

const TransformStack* find_stack(const Clip& clip, int node) {
  const auto found =
      std::find_if(clip.stacks.begin(), clip.stacks.end(), [&](const TransformStack& s) { return s.node == node; });
  return found == clip.stacks.end() ? nullptr : &*found;
}

namespace {

std::vector<const Curve*> curves_of(const Clip& clip, int node) {
  std::vector<const Curve*> out;
  std::vector<std::int32_t> used;
  const TransformStack* stack = find_stack(clip, node);
  if (stack == nullptr) return out;
  add_curves(*stack, used);
  for (const ElementaryTransform& e : stack->elements)
    for (const LayeredNumbers& said : e.numbers.layers)
      if (const std::int32_t weight = clip.curves.layers[at(said.layer)].weight_curve; weight >= 0)
        used.push_back(weight);
  for (const std::int32_t c : used) out.push_back(&clip.curves.curves[at(c)]);
  return out;
}

double just_before(double time) {
  return static_cast<double>(std::nextafter(static_cast<float>(time), -1e30f));
}

}  // namespace

bool clip_moves(const Clip& clip, int node) {
  return find_channel(clip, node) != nullptr || !curves_of(clip, node).empty();
}

bool varies(const Clip& clip, int node) {
  if (const Channel* channel = find_channel(clip, node))
    for (const Track* track : {&channel->translation, &channel->rotation, &channel->scale})
      for (std::size_t v = track->stride(); v < track->values.size(); ++v)
        if (track->values[v] != track->values[v - track->stride()]) return true;
  for (const Curve* curve : curves_of(clip, node)) {
    if (curve->empty()) continue;
    const auto differs = [&](double v) { return v != curve->values.front(); };
    const auto bulges = [](const CurveHandles& h) { return h.before_value != 0 || h.after_value != 0; };
    if (std::any_of(curve->values.begin(), curve->values.end(), differs) ||
        std::any_of(curve->handles.begin(), curve->handles.end(), bulges))
      return true;
  }
  return false;
}

std::vector<double> key_times(const Clip& clip, int node) {
  std::vector<double> keys;
  if (const Channel* channel = find_channel(clip, node))
    for (const Track* track : {&channel->translation, &channel->rotation, &channel->scale}) {
      keys.insert(keys.end(), track->times.begin(), track->times.end());
      if (track->interpolation != KeyInterpolation::k_step) continue;
      const auto width = static_cast<std::ptrdiff_t>(track->stride());
      for (std::size_t k = 1; k < track->times.size(); ++k) {  // a step between two straight lines
        const auto value = track->values.begin() + static_cast<std::ptrdiff_t>(k) * width;
        if (!std::equal(value, value + width, value - width)) keys.push_back(just_before(track->times[k]));
      }
    }
  for (const Curve* curve : curves_of(clip, node))
    for (std::size_t k = 0; k < curve->times.size(); ++k) {
      keys.push_back(curve->times[k]);
      if (k == 0) continue;
      const CurveInterpolation how =
          curve->interpolation.empty() ? CurveInterpolation::k_linear : curve->interpolation[k - 1];
      if (how == CurveInterpolation::k_constant && curve->values[k] != curve->values[k - 1])
        keys.push_back(just_before(curve->times[k]));
      if (how == CurveInterpolation::k_constant_next && curve->values[k] != curve->values[k - 1])
        keys.push_back(static_cast<double>(std::nextafter(static_cast<float>(curve->times[k - 1]), 1e30f)));
    }
  return keys;
}

Status check_changes(const Character& character, int clip, std::span<const ChangedChannel> changes) {
  if (clip < 0 || at(clip) >= character.clips.size())
    return usage_error("clip " + std::to_string(clip) + " to be changed does not exist");
  for (const ChangedChannel& change : changes) {
    if (change.node < 0 || at(change.node) >= character.nodes.size())
      return usage_error("node " + std::to_string(change.node) + " to be changed does not exist");
    const std::string where = "node \"" + character.nodes[at(change.node)].name + "\"";
    const Track& track = change.track;
    if (track.empty() || track.width != (change.path == ChannelPath::k_rotation ? 4 : 3) ||
        track.values.size() != track.times.size() * track.stride())
      return usage_error("new keys and their values do not match", where);
    const auto finite = [](double v) { return std::isfinite(static_cast<float>(v)); };
    if (!std::all_of(track.times.begin(), track.times.end(), finite) ||
        !std::all_of(track.values.begin(), track.values.end(), finite))
      return usage_error("a new key is not a finite 32-bit number", where);
    for (std::size_t i = 1; i < track.times.size(); ++i)
      if (!(static_cast<float>(track.times[i]) > static_cast<float>(track.times[i - 1])))
        return usage_error("new key times do not ascend as 32-bit numbers", where);
  }
  return {};
}

Status apply_changes(Character& character, int clip, std::span<const ChangedChannel> changes) {
  if (Status s = check_changes(character, clip, changes); !s) return s;
  Clip& target = character.clips[at(clip)];
  for (const ChangedChannel& change : changes) {
    auto channel = std::find_if(target.channels.begin(), target.channels.end(),
                                [&](const Channel& c) { return c.node == change.node; });
    if (channel == target.channels.end()) {
      target.channels.emplace_back().node = change.node;
      channel = std::prev(target.channels.end());
    }
    track_of(*channel, change.path) = change.track;
  }
  return {};
}

}  // namespace ft::inline io

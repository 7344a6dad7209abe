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

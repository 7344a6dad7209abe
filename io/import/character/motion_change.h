// Channels of a clip with other keys than the file has: what an adjusted motion is made of. Applied to a character it
// plays; written into a copy of the file (io/export) it goes back to the animator.
#pragma once

#include <span>
#include <vector>

#include "io/import/character/character.h"

namespace ft::inline io {

enum class ChannelPath { k_translation, k_rotation, k_scale };

/// New keys for one part of one node's transform, in the file's units and axes, relative to the parent. Times [s] are
/// those of the file.
struct ChangedChannel {
  int node = -1;
  ChannelPath path = ChannelPath::k_translation;
  Track track;
};

/// The nearest number that a 32-bit float holds. Out of line on purpose: where g++ 12 vectorises the way to float and
/// back at -O3, it leaves the rounding out.
double round_to_float(double value);

Track& track_of(Channel& channel, ChannelPath path);
const Track& track_of(const Channel& channel, ChannelPath path);

/// The channel of a node; null when the clip has none for it.
const Channel* find_channel(const Clip& clip, int node);
/// The stack of transforms of a node; null when the clip has none for it.
const TransformStack* find_stack(const Clip& clip, int node);
/// Whether anything in the clip moves the node: it has a channel, or a stack with curves.
bool clip_moves(const Clip& clip, int node);
/// Whether the node is anywhere else at one time of the clip than at another.
bool varies(const Clip& clip, int node);
/// Times [s] at which the clip has keys of the node, in any order, some of them twice. Where a value jumps at a key,
/// the last time before it that a 32-bit float holds is among them.
std::vector<double> key_times(const Clip& clip, int node);

/// Puts the new keys in place; a node that the clip does not move gets a channel. Nodes and widths are checked.
Status apply_changes(Character& character, int clip, std::span<const ChangedChannel> changes);
/// A bad clip, node, width or count of values, times that do not ascend as 32-bit numbers, values that are not finite.
Status check_changes(const Character& character, int clip, std::span<const ChangedChannel> changes);

}  // namespace ft::inline io

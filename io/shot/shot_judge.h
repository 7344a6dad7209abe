// What ValueReader and the key table cannot tell alone: the small grammars as values, and what holds between
// sections.
#pragma once

#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "io/shot/ranges.h"
#include "io/shot/shot.h"
#include "io/shot/shot_values.h"

namespace ft {

/// "1001-1121" or 1001; at most 100 000 frames.
std::optional<FrameRange> read_frames(const ValueReader& reader, const Value& value);

/// "0-199, 250" or [0, 1, "5-9"]; nothing is changed by a fault.
void read_vertices(const ValueReader& reader, const Value& value, std::vector<int>& out);

/// "detect", "ignore", or frames; "contact" or a frame.
void read_teleports(const ValueReader& reader, const Value& value, const Allowed& frames, PrimarySpec& spec);
void read_release(const ValueReader& reader, const Value& value, const Allowed& frames, PrimarySpec& spec);

/// A pin that never holds, or fades without an end to do it at.
void judge_hold(const std::string& owner, const Value& value, const PinSpec& pin, FaultList& faults);

/// Where a path of keys stands; as far as it exists.
Place place_of(const Value& root, std::initializer_list<std::string_view> path);

/// Props, cords and stand-ins that want for a key or have one too many, and who is coupled to whom and how.
void judge_couplings(const Value& root, Shot& shot, FaultList& faults);

/// Who wears what, names that would overwrite each other, limits that contradict. Fills in `on` when there is one
/// primary.
void judge_whole(const Value& root, Shot& shot, FaultList& faults);

}  // namespace ft

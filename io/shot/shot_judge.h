// What ValueReader and the key table cannot tell alone: the two small grammars as values, and what holds between
// sections.
#pragma once

#include <optional>
#include <vector>

#include "io/shot/ranges.h"
#include "io/shot/shot.h"
#include "io/shot/shot_values.h"

namespace ft {

/// "1001-1121" or 1001; at most 100 000 frames.
std::optional<FrameRange> read_frames(const ValueReader& reader, const Value& value);

/// "0-199, 250" or [0, 1, "5-9"]; nothing is changed by a fault.
void read_vertices(const ValueReader& reader, const Value& value, std::vector<int>& out);

/// A pin that never holds, or fades without an end to do it at.
void judge_hold(const std::string& owner, const Value& value, const PinSpec& pin, FaultList& faults);

/// Who wears what, names that would overwrite each other, limits that contradict. Fills in `on` when there is one
/// primary.
void judge_whole(const Value& root, Shot& shot, FaultList& faults);

}  // namespace ft

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

namespace ft::inline io {

/// "1001-1121" or 1001; at most 100 000 frames.
std::optional<FrameRange> read_frames(const ValueReader& reader, const Value& value);

/// "detect", "ignore", or frames; "contact" or a frame.
void read_teleports(const ValueReader& reader, const Value& value, const Allowed& frames, PrimarySpec& spec);
void read_release(const ValueReader& reader, const Value& value, const Allowed& frames, PrimarySpec& spec);

/// Where a path of keys stands; as far as it exists.
Place place_of(const Value& root, std::initializer_list<std::string_view> path);

/// Props and stand-ins that want for a key or have one too many, and who is coupled to whom and how.
void judge_couplings(const Value& root, Shot& shot, FaultList& faults);

/// Fields of moving air that want for a key or have one too many. Fills in `of` when there is one primary.
void judge_winds(const Value& root, Shot& shot, FaultList& faults);

/// Who wears what, names that would overwrite each other, limits that contradict. Fills in `on` when there is one
/// primary.
void judge_whole(const Value& root, Shot& shot, const ShotVocabulary& vocabulary, FaultList& faults);

}  // namespace ft::inline io

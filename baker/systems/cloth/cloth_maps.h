// Maps of the shot file: what of a cloth can vary over its surface, within which range, and what is wrong with a table
// of maps. For the reader, the reference, and the conductor, which judges the values themselves by the same ranges.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "baker/systems/cloth/cloth_spec.h"
#include "io/shot/shot_values.h"

namespace ft::inline baker {

struct MapKind {
  std::string_view name;
  double lowest, highest;
  std::string_view unit;
  std::string_view also;  ///< other words people write for it
};

std::span<const MapKind> map_kinds();
/// Null when there is no such kind.
const MapKind* find_map_kind(std::string_view name);
std::vector<std::string> map_words();

/// Faults of one table of maps as it was read from `value`: one source, both ends and within what is allowed.
void judge_map(const std::string& owner, const Value& value, const MapSpec& map, FaultList& faults);

/// Faults of a cloth's maps taken together: nothing varies by two maps.
void judge_maps(const std::string& owner, const Value& list, std::span<const MapSpec> maps, FaultList& faults);

/// A column is named and no file (in a map or a pin).
void judge_column(const std::string& owner, const Value& value, FaultList& faults);

}  // namespace ft::inline baker

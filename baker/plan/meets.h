// Which primaries of a shot a secondary can meet beside its own, whatever its kind.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "baker/plan/plan.h"

namespace ft::inline baker {

/// Per primary: not 0 where one of the patterns of a secondary's `meets` names it; its own is always met. Error: a
/// pattern that names none. A liquid is met where it is named without `*` and `?`.
Result<std::vector<char>> meets_of(std::span<const std::string> patterns, const std::string& own,
                                   std::span<const PrimaryPlan> primaries);

/// Whether a primary stands still in all frames of the shot, pre-roll included.
bool stands_still(const Shot& shot, const PrimaryPlan& primary);

/// Whether a secondary moves the primary while it is solved.
bool is_two_way(const Shot& shot, const std::string& primary);

/// shot: all of it, whatever its stages. Why secondaries of other primaries cannot meet a primary; empty: they can.
std::string why_alone(const Shot& shot, const PrimaryPlan& primary);

}  // namespace ft::inline baker

// The air of a shot: its fields of moving air and what stands in them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "baker/plan/plan.h"
#include "solvers/wind/wind.h"

namespace ft::inline baker {

/// Of planned primaries. Errors say where; what is guessed goes into the notes.
Result<std::shared_ptr<const Wind>> plan_wind(const Shot& shot, std::span<const PrimaryPlan> primaries,
                                              std::vector<std::string>& notes);

/// What --dry-run says of it, a line for each field.
std::vector<std::string> wind_lines(const Shot& shot, const Wind& wind);

}  // namespace ft::inline baker

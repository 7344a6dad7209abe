// The feasible collider of several primaries in one, taken apart again: each primary has a cache of its own part of it,
// and what a secondary does not meet is numbered as that cache has it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/types.h"
#include "solvers/base/solver.h"

namespace ft::inline baker {

struct ColliderSlice {
  std::size_t primary = 0;          ///< into BakePlan::primaries
  std::string name;                 ///< of the cached system: "walker.collider"; the primary's own where it is fixed
  bool fixed = false;               ///< nothing there gives way (it is a sheet, too): the body as drawn
  std::vector<int> vertices;        ///< of the whole collider, ascending: those of the drawn body first
  std::vector<Triangle> triangles;  ///< in the slice's own numbers
  std::vector<char> met_by{};       ///< per system of the group: not 0 where it meets this; empty: all do
};

/// Of each slice what the runs, which are in the whole collider's numbers, have of it.
std::vector<AbsentRuns> sliced(const AbsentRuns& runs, std::span<const ColliderSlice> slices);

}  // namespace ft::inline baker

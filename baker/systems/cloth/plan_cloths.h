// Garments in a plan: read, placed, joined, checked, with their fabrics, maps and pins.
#pragma once

#include "baker/systems/cloth/cloth_group.h"
#include "baker/systems/cloth/cloth_spec.h"

namespace ft::inline baker {

/// The cloths of one primary, as if they met nothing else; without poses.
Result<std::unique_ptr<ClothGroup>> cloths_of(const Shot& shot, std::size_t primary, BakePlan& plan);

/// All cloths of a shot whose primaries are planned, in groups of what may meet, by their first primary. Notes go into
/// the plan.
Result<std::vector<std::unique_ptr<ClothGroup>>> plan_cloths(const Shot& shot, BakePlan& plan);

/// What all groups of a shot have in common.
ClothSetup common_setup(const Shot& shot, const BakePlan& plan);

}  // namespace ft::inline baker

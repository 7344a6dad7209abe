// Garments in a plan: read, placed, joined, checked, with their fabrics, maps and pins.
#pragma once

#include "baker/plan.h"

namespace ft {

/// The garments of one primary, as a group of their own; `plan` stays as it is where there are none.
Status plan_cloths(const Shot& shot, std::size_t primary, BakePlan& plan);

/// What all groups of a shot have in common.
ClothSetup common_setup(const Shot& shot);

}  // namespace ft

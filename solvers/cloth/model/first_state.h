// Where a bake of cloth begins: garments as they are placed, in free fall or held, and what of the body they do not
// meet.
#pragma once

#include <vector>

#include "baker/core/state.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

/// tangled: as ClothMotion has it; empty: nothing is.
State first_state(const ClothModel& model, const std::vector<char>& tangled);

}  // namespace ft::inline solvers

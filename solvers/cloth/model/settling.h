// Cloth that starts through cloth gets out of it before the pre-roll, the body standing still: for how long.
#pragma once

#include "baker/core/state.h"
#include "solvers/cloth/model/cloth_setup.h"

namespace ft::inline solvers {

/// How far a state has come, and whether it goes on.
Settling settling_of(const ClothSetup& setup, const State& state);
/// A frame of settling is over; crossings: among cloths, that it left.
void count_settled(int crossings, State& state);

}  // namespace ft::inline solvers

// Shallow water for a scene.
#pragma once

#include "solvers/water/shallow/shallow_setup.h"
#include "solvers/water/water_core.h"

namespace ft::inline solvers {

/// Refuses as ShallowSolver::make() does.
Result<std::unique_ptr<WaterCore>> shallow_core(ShallowSetup setup);

}  // namespace ft::inline solvers

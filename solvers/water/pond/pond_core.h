// A pond for a scene.
#pragma once

#include "solvers/water/pond/pond_setup.h"
#include "solvers/water/water_core.h"

namespace ft::inline solvers {

/// Refuses as PondSolver::make() does.
Result<std::unique_ptr<WaterCore>> pond_core(PondSetup setup);

}  // namespace ft::inline solvers

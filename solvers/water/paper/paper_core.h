// The water of the paper, for a scene.
#pragma once

#include "solvers/water/paper/paper_setup.h"
#include "solvers/water/water_core.h"

namespace ft::inline solvers {

/// Refuses as PaperSolver::make() does.
Result<std::unique_ptr<WaterCore>> paper_core(PaperSetup setup);

}  // namespace ft::inline solvers

// The cloth solver on coarser garments, answering for the given ones: for previews.
#pragma once

#include <memory>

#include "solvers/cloth/model/cloth_setup.h"

namespace ft::inline solvers {

/// As make_cloth_solver(), with edges setup.coarsen times as long. Systems, their positions and the vertices of
/// incidents are those of the given garments; crossings, gaps and strains are those of the coarser ones, which is what
/// moved, in the solver that make_inner makes.
Result<std::unique_ptr<Solver>> make_coarse_solver(ClothSetup setup, const ClothSolverMaker& make_inner);

}  // namespace ft::inline solvers

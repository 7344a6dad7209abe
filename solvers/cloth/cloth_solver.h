// Cloth on a moving body: all garments of a primary in one system, one potential. Per substep the body advances while
// the cloth is carried along, checked by conservative CCD; then Newton minimises inertia + elasticity + contact +
// friction + pins with the body still, every displacement truncated so that nothing crosses. See cloth_solver.cpp for
// the walk of a frame.
#pragma once

#include <memory>

#include "solvers/cloth/model/cloth_setup.h"

namespace ft::inline solvers {

/// Checks the setup (pins in range, garments not empty) and builds the model.
Result<std::unique_ptr<Solver>> make_cloth_solver(ClothSetup setup);

}  // namespace ft::inline solvers

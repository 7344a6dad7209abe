// Cords and props in a plan: what generators and couplings of the shot file come to.
#pragma once

#include "baker/systems/cords/cords_group.h"
#include "baker/systems/cords/cords_spec.h"
#include "solvers/cords/generators.h"

namespace ft::inline baker {

/// The cords of one primary, with it as their prop and the others that they meet; null where there are none. Notes go
/// into the plan.
Result<std::unique_ptr<CordsGroup>> cords_of(const Shot& shot, std::size_t primary, BakePlan& plan);

/// The graph that a shot file's table means [m].
Result<CordGraph> cord_graph(const CordsSpec& spec);

}  // namespace ft::inline baker

// Cords and props in a plan: what generators and couplings of the shot file come to.
#pragma once

#include "baker/systems/cords/cords_group.h"
#include "baker/systems/cords/cords_spec.h"
#include "solvers/cords/generators.h"

namespace ft::inline baker {

/// The cords of one primary, with it as their prop; null where there are none.
Result<std::unique_ptr<CordsGroup>> cords_of(const Shot& shot, std::size_t primary, const BakePlan& plan);

/// The graph that a shot file's table means [m].
Result<CordGraph> cord_graph(const CordsSpec& spec);

}  // namespace ft::inline baker

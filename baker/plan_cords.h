// Cords and props in a plan: what generators and couplings of the shot file come to.
#pragma once

#include "baker/plan.h"

namespace ft {

/// The cords of one primary, with it as their prop, as a group of their own; `plan` stays as it is where there are
/// none.
Status plan_cords(const Shot& shot, std::size_t primary, BakePlan& plan);

/// The graph that a shot file's table means [m].
Result<CordGraph> cord_graph(const CordsSpec& spec);

}  // namespace ft

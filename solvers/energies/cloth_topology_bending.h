// The parts of make_cloth_topology() that concern bending.
#pragma once

#include "solvers/energies/cloth_topology.h"

namespace ft::inline solvers {

/// Fills hinges from triangles, rest shape and areas.
void add_hinges(ClothTopology& topology);

/// Fills bends from hinges, rest shape and fabrics.
void add_bend_elements(ClothTopology& topology);

}  // namespace ft::inline solvers

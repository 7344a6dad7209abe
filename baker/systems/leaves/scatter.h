// Where leaves are at the start: by lot over a rectangle or a mesh, or from a file.
#pragma once

#include "baker/core/result.h"
#include "baker/systems/leaves/leaves_spec.h"
#include "solvers/leaves/leaves_setup.h"

namespace ft::inline baker {

/// Ids from 0, prototype 0; headings, scales and, of what hangs in the air, tilts by lot. What lies sleeps. Errors: a
/// mesh without an upper face, lines that are no places.
Result<std::vector<Leaf>> scatter(const LeavesSpec& spec, const LeafPrototype& prototype);

/// What is said of the spec's leaf.
Result<LeafPrototype> leaf_prototype(const LeavesSpec& spec);

}  // namespace ft::inline baker

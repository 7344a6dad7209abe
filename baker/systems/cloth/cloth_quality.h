// What `quality = "preview"` means for cloth: the same solver on coarser garments and a coarser collider, in longer
// steps.
#pragma once

#include "io/shot/shot.h"
#include "solvers/cloth/cloth_solver.h"

namespace ft::inline baker {

/// Makes a setup a preview's; a final one stays as it is. Its primary is with_quality()'s.
void apply_quality(const Shot& shot, ClothSetup& setup);
/// What a preview, with its setup, has for a primary.
std::shared_ptr<const Trajectory> with_quality(const Shot& shot, const ClothSetup& setup,
                                               std::shared_ptr<const Trajectory> primary);

}  // namespace ft::inline baker

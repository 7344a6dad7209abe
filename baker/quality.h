// What `quality = "preview"` means: the same solver on coarser garments and a coarser collider, in longer steps. One
// place, so that bake, dry run and manifest say the same.
#pragma once

#include <string>

#include "baker/manifest.h"
#include "io/shot/shot.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/lockstep/lockstep_solver.h"

namespace ft {

bool is_preview(const Shot& shot);
/// By the settings that a bake was made with.
bool is_preview(const Manifest& manifest);

/// Makes a setup a preview's; a final one stays as it is. Its primary is with_quality()'s.
void apply_quality(const Shot& shot, ClothSetup& setup);
/// What a preview, with its setup, has for a primary.
std::shared_ptr<const Trajectory> with_quality(const Shot& shot, const ClothSetup& setup,
                                               std::shared_ptr<const Trajectory> primary);
void apply_quality(const Shot& shot, LockstepSetup& setup);

/// For the log and the manifest: what a preview's certificate is worth.
std::string quality_note();

}  // namespace ft

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

/// Makes a setup, with its primary, a preview's; a final one stays as it is.
void apply_quality(const Shot& shot, ClothSetup& setup);
void apply_quality(const Shot& shot, LockstepSetup& setup);

/// For the log and the manifest: what a preview's certificate is worth.
std::string quality_note();

}  // namespace ft

// `quality = "preview"`: the same solvers, coarser and in longer steps. What it means for a kind of secondary is in the
// kind's folder.
#pragma once

#include <string>

#include "baker/record/manifest.h"
#include "io/shot/shot.h"

namespace ft::inline baker {

bool is_preview(const Shot& shot);
/// By the settings that a bake was made with.
bool is_preview(const Manifest& manifest);

/// For the log and the manifest: what a preview's certificate is worth.
std::string quality_note();

}  // namespace ft::inline baker

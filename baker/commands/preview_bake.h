// One bake as the preview's page holds it: meshes that move, strain and gap, the primaries' paths, the frames' numbers.
#pragma once

#include <filesystem>

#include "baker/core/result.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

/// curve_bytes: what its curves may take of the page, > 0. Errors: no manifest, no finished frame, caches that do not
/// belong to it (k_input).
Result<Json> preview_bake(const std::filesystem::path& bake_folder, double curve_bytes = 64e6);

}  // namespace ft::inline baker

// A primary from a geometry cache: samples -> place -> Trajectory. Each thing that was repaired or guessed is a note.
#pragma once

#include "baker/core/result.h"
#include "io/import/character/import_request.h"

namespace ft::inline io {

Result<ImportedPrimary> import_geometry_cache(const ImportRequest& request);

}  // namespace ft::inline io

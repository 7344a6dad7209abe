// What `check` says of hair, from the caches of strands and of what they met: vertices inside of bodies, segments
// through sheets, and lengths beside those of the first frame.
#pragma once

#include "baker/record/cache_track.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

Result<std::unique_ptr<JudgedGroup>> judged_hair(const CachedBake& bake, const ManifestSystem& system);

}  // namespace ft::inline baker

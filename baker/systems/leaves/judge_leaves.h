// What `check` says of leaves: their crossings with the bodies that they met, from the caches of both.
#pragma once

#include "baker/record/cache_track.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

Result<std::unique_ptr<JudgedGroup>> judged_leaves(const CachedBake& bake, const ManifestSystem& system);

}  // namespace ft::inline baker

// What `check` says of water: whether its caches hold water that stays where its grid is, and droplets that are drops.
#pragma once

#include "baker/record/cache_track.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

Result<std::unique_ptr<JudgedGroup>> judged_water(const CachedBake& bake, const ManifestSystem& system);

}  // namespace ft::inline baker

// The bodies that a system of a finished bake met, out of their caches.
#pragma once

#include <string>
#include <vector>

#include "baker/record/cache_track.h"

namespace ft::inline baker {

struct MetBodies {
  std::vector<CacheTrack> bodies;
  std::vector<std::string> missing;  ///< what it met and is not cached
};

/// Bodies as they were drawn, and what was baked before, "cloth.robe"; of a system that names none, the one that it is
/// on.
Result<MetBodies> met_bodies(const CachedBake& bake, const ManifestSystem& system);

}  // namespace ft::inline baker

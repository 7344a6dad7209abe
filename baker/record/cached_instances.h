// Instances of a finished bake: that they are those of its manifest, and their prototypes out of the one file that has
// all of them.
#pragma once

#include <filesystem>

#include "baker/record/cache_track.h"

namespace ft::inline baker {

/// Of a track with cache and topology. Error: number, ids or prototypes that are not the manifest's (k_input).
Status add_instances(const std::filesystem::path& folder, const ManifestSystem& system, CacheTrack& track);

}  // namespace ft::inline baker

// What a hybrid pass leaves in the bake folder, for the animator: PRIMARY_hybrid.glb and .bvh, the adjusted motion of a
// character, and PRIMARY_hybrid.json, the forces and the deviation of every frame.
#pragma once

#include <filesystem>

#include "baker/plan/plan.h"
#include "baker/record/manifest.h"

namespace ft::inline baker {

/// Of all hybrid primaries; each file appears whole. Names, sizes and hashes for the manifest. notes: what of the files
/// is not the original's.
Result<std::vector<ManifestFile>> write_hybrid_files(const BakePlan& plan, const std::filesystem::path& folder,
                                                     std::vector<std::string>& notes);

}  // namespace ft::inline baker

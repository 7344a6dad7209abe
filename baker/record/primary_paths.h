// Where the primaries of a bake went, as their caches have it: for all that sets bakes of one shot beside each other.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/record/manifest.h"

namespace ft::inline baker {

struct PrimaryPath {
  std::string primary;
  std::vector<Vec3> centres;  ///< mean of its vertices, of each written frame [m]
};

/// Of every drawn body that is cached. Errors: caches that do not belong to the manifest (k_input).
Result<std::vector<PrimaryPath>> primary_paths(const std::filesystem::path& bake_folder, const Manifest& manifest);

}  // namespace ft::inline baker

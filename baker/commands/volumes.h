// volumes: the water of a finished bake as OpenVDB files, one for each frame, from its caches.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline baker {

struct VolumesOptions {
  std::filesystem::path folder;  ///< of the bake
  std::filesystem::path output;  ///< folder for the files; empty: the bake's
  double voxel = 0;              ///< m; 0: as large as the cells of the water's grid
  bool keep = false;             ///< files that are there and newer than their caches stay
};

/// Names of the files of one system, "pond.0001.vdb ... pond.0192.vdb", and what to set where they are opened: lines to
/// be printed. Errors: no bake, no water in it, a cache that cannot be read, no space.
Result<std::vector<std::string>> write_volumes(const VolumesOptions& options);

/// The command: prints, gives the exit code.
int run_volumes(const VolumesOptions& options);

}  // namespace ft::inline baker

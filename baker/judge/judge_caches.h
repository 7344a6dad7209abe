// Judges a bake from its caches, as any other program would see them: nothing that the solver said of itself is
// believed, but what of the feasible collider was absent for which cloth, which the manifest has for every frame.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "solvers/base/solver.h"

namespace ft::inline baker {

struct CacheJudgement {
  std::string shot;
  /// Crossings, penetration, strain, what was absent (as numbers); the gap, which is infinite where no kind measures
  /// it. Energy is not judged.
  std::vector<FrameReport> frames;
  bool complete = false;           ///< the bake came to its end
  int frame_count = 0;             ///< that the caches should have
  int missing_frames = 0;          ///< of those
  std::vector<std::string> notes;  ///< what could not be judged
};

/// Reads every frame of every cache in the first format of each system, as far as all have it. Each kind of secondary
/// judges its own systems (systems/system.h); of what is no mesh every frame is read whatever its kind looks at. Error:
/// caches that do not belong to the manifest, frames that are not finite, instances that are not those of the manifest
/// (k_input).
Result<CacheJudgement> judge_caches(const std::filesystem::path& bake_folder);

}  // namespace ft::inline baker

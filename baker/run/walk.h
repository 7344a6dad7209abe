// The walk over the frames of one plan, from its start or from a checkpoint.
#pragma once

#include <optional>

#include "baker/plan/room_report.h"
#include "baker/record/bake_folder.h"
#include "baker/record/manifest.h"
#include "baker/run/cache_set.h"
#include "baker/run/checkpoint.h"
#include "baker/run/progress.h"

namespace ft::inline baker {

struct WalkResult {
  Manifest manifest;   ///< as far as the walk came; complete when it reached the end
  Status status;       ///< k_interrupted after a signal
  double seconds = 0;  ///< wall
};

/// manifest: inputs and settings filled in. from: a checkpoint of this very bake. The caches of `caches` are opened
/// here. Writes report.json (times, per frame and phase, and the memory that was used; room goes into it) before the
/// manifest says that the bake is complete, so that no complete bake lacks it, and when interrupted.
WalkResult walk(const BakePlan& plan, const Solvers& solvers, CacheSet& caches, const BakeFolder& folder,
                Manifest manifest, std::optional<Checkpoint> from, const RoomReport& room, Progress& progress);

/// Certificate of a state that no solver has reported on (the first one, when there is no pre-roll).
FrameReport certify_start(const BakePlan& plan, const Solvers& solvers, const CacheSet& caches,
                          std::span<const State> states);

}  // namespace ft::inline baker

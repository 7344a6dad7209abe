// What the stages of a chain that are done have come to, on disk while later ones are baked, so that a bake that is
// interrupted in one of these goes on from there. Written before the first checkpoint of the stage that comes next.
#pragma once

#include <span>
#include <vector>

#include "baker/core/hash.h"
#include "baker/record/bake_folder.h"
#include "baker/record/manifest.h"

namespace ft::inline baker {

struct FinishedStages {
  Hash128 fingerprint;  ///< of the bake that they belong to
  int last = 0;         ///< the stage that was finished last
  Manifest manifest;    ///< of all of them: systems with their contents, notes, frames with their profiles
};

Status finish_stage(const BakeFolder& folder, const FinishedStages& stages);
Result<FinishedStages> read_finished_stages(const BakeFolder& folder);
/// Of a complete bake: removes them and the motion of their systems.
void forget_stages(const BakeFolder& folder, const Manifest& manifest);

/// Reports of the same frames of two stages as one; those of one stage alone as they are.
std::vector<FrameReport> merged(std::span<const FrameReport> earlier, std::span<const FrameReport> later);

}  // namespace ft::inline baker

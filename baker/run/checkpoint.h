// .state/checkpoint: all that a bake needs to go on as if it had never stopped: the solvers' states, and the reports of
// the frames so far. One file, replaced whole, written after the caches of the frame before it: a frame's velocities
// need the next one, so that caches follow one frame behind. They may be ahead of that, never behind.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/result.h"
#include "baker/core/state.h"
#include "solvers/base/solver.h"

namespace ft::inline baker {

struct Checkpoint {
  Hash128 fingerprint;               ///< of the bake that it belongs to
  int stage = 0;                     ///< of a chain; earlier ones are finished, see BakeFolder::stages()
  int frame = 0;                     ///< all states are at this frame
  std::vector<State> states;         ///< one per group of the plan
  std::vector<FrameReport> reports;  ///< of all frames up to this one, profiles included
  std::string manifest;              ///< of finished stages: what the caches are; else empty
  /// Per cached system: x y z of its vertices [m] in the frame before this one, where its velocities need them; nothing
  /// before the first.
  std::vector<std::vector<float>> before{};
};

/// What is saved of a checkpoint, which must outlive it.
ByteParts parts_of(const Checkpoint& checkpoint);
Bytes save(const Checkpoint& checkpoint);
/// Refuses anything cut, damaged or of another version.
Result<Checkpoint> load_checkpoint(std::span<const std::byte> data);

}  // namespace ft::inline baker

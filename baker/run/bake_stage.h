// One stage of a bake after the other: what is told before its first frame, its solvers, its caches, the walk. Most
// shots have one stage; a chain (io/shot/chains.h) has several, and what was baked in one is a body of the next.
#pragma once

#include <optional>
#include <span>

#include "baker/plan/carrier.h"
#include "baker/record/bake_folder.h"
#include "baker/run/bake.h"
#include "baker/run/checkpoint.h"
#include "baker/run/walk.h"

namespace ft::inline baker {

/// Of the places without room, so many are told before the first frame; report.json has them all.
inline constexpr std::size_t k_room_lines = 5;

class StageBake {
 public:
  /// before: what the folder's manifest said. from: where an interrupted bake goes on.
  StageBake(const BakeServices& services, const BakeFolder& folder, const Manifest& before,
            std::optional<Checkpoint> from, Progress& progress)
      : services_(services), folder_(folder), before_(before), from_(std::move(from)), progress_(progress) {}

  /// manifest: of the stages before; that of all until now comes out. A stage that the checkpoint is beyond is not
  /// baked again. Error: before the first frame.
  Result<WalkResult> bake(BakePlan& plan, Manifest manifest);
  /// carriers: of `plan`, before it was baked.
  Result<BakePlan> plan_next(const BakePlan& plan, std::span<const Carrier> carriers) const;

 private:
  void tell(const BakePlan& plan, Manifest& manifest) const;
  Result<Solvers> make_solvers(const BakePlan& plan) const;
  Status write_files(const BakePlan& plan, Manifest& manifest) const;

  const BakeServices& services_;
  const BakeFolder& folder_;
  const Manifest& before_;
  std::optional<Checkpoint> from_;
  Progress& progress_;
  std::vector<RoomReport> room_;  ///< of each stage so far
};

}  // namespace ft::inline baker

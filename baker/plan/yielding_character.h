// An imported character that yields: the hybrid pass over its clip, the clip's channels as they are afterwards, and the
// character playing them, by which its secondaries are baked. Legs whose feet stand may be planted.
#pragma once

#include <memory>

#include "baker/plan/hybrid.h"
#include "io/export/bvh_export.h"
#include "io/import/motion/adjust.h"
#include "io/import/motion/placed_character.h"

namespace ft::inline baker {

struct YieldingCharacter {
  ImportRequest request;
  std::shared_ptr<const PlacedCharacter> imported;
  AdjustedMotion motion;
  BvhFrames frames;  ///< of the shot, in the clip's time
};

struct YieldedCharacter {
  HybridPass pass;
  YieldingCharacter character;
  std::unique_ptr<Trajectory> trajectory;  ///< adjusted
  std::vector<std::string> notes;
};

/// Whether it has joints, and so is no rigid prop.
bool has_joints(const PlacedCharacter& character);

/// trajectory: of the motion as it was imported. mass: kg, 0 if not known. Errors: of the pass, of the adjustment, and
/// a character that plays no clip.
Result<YieldedCharacter> yield_character(const Shot& shot, const PrimarySpec& spec, const ImportRequest& request,
                                         std::shared_ptr<const PlacedCharacter> character, const Trajectory& trajectory,
                                         double mass);

}  // namespace ft::inline baker

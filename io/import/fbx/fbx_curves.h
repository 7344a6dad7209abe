// AnimationCurve objects -> Curve. Keys carry flags (interpolation, how tangents are made, weights) in runs, and the
// tangents of the stretch that follows: the slope on its left end and on its right end.
#pragma once

#include "baker/core/result.h"
#include "io/import/character/curve.h"
#include "io/import/fbx/fbx_document.h"

namespace ft::inline io {

/// What of the file's curves could not be taken as it stands.
struct FbxCurveFaults {
  int damaged = 0;    ///< counts of keys, values or flags that do not match: without keys
  int unordered = 0;  ///< keys that were not later than the one before: left out
  int velocity = 0;   ///< curves whose tangents have velocities, which are not evaluated
};

/// Ticks in a second: 46186158000, or 141120000 where the file's header chooses the newer ones.
double fbx_ticks_per_second(const FbxDocument& document);

/// A curve with no keys where it is damaged.
Curve read_fbx_curve(const FbxObject& object, int version, double ticks_per_second, FbxCurveFaults& faults);

}  // namespace ft::inline io

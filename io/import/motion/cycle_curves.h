// Curves and stacks of transforms of a clip that repeats (cycle.h).
#pragma once

#include <span>

#include "io/import/character/character.h"

namespace ft::inline io {

/// What of a clip is repeated: cycles `first` to `last` of that length, 0 the one that begins at `start` [s].
struct RepeatedSpan {
  double start = 0, period = 0;
  long first = 0, last = 0;
  double begin_of(long cycle) const { return start + static_cast<double>(cycle) * period; }
};

inline constexpr double k_curve_samples =
    480;  ///< straight lines per second of a curve that is not repeated by its keys

/// The curve once for each cycle, key by key; the last key of a cycle and the first of the next share their time. Where
/// the curve goes on beyond its keys, or beyond the cycle, it is straight lines of 1/480 s; of jumps within one of them
/// the largest stays a jump.
Curve repeated_curve(const Curve& curve, const RepeatedSpan& span);

/// Puts a placement before the stack's own transforms, another one in each cycle: lengths as the stack has them.
void place_cycles(const RepeatedSpan& span, std::span<const Vec3> translations, std::span<const Quat> rotations,
                  TransformStack& stack, ClipCurves& curves);

}  // namespace ft::inline io

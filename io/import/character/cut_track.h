// The part of a track within a span of time.
#pragma once

#include "io/import/character/character.h"

namespace ft::inline io {

/// Keys from `begin` to `end` [s]; where a curve goes on beyond them, keys at both with the values, and the slopes,
/// that it has there. As it is where no key lies outside. Not for an empty track.
Track cut_track(const Track& track, double begin, double end, bool rotation);

}  // namespace ft::inline io

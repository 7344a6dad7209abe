// A kind of secondary for tests: [tress.NAME], hair that swings on a ball beside the box. Its strands are curves: what
// the conductor does with them. The phase of the swing goes on from frame to frame, so that a resume from the wrong
// state shows.
#pragma once

#include "baker/systems/interface/system.h"
#include "tests/support/combed_ball.h"

namespace ft::test {

struct TressSpec final : SecondarySpec {
  int strands = 20, vertices = 8;
  bool turned = false;  ///< the strands stand in the opposite order
  double swing = 0.5;   ///< [rad]

  CombedBall ball() const;
};

/// Sections:
///   [tress.NAME]
///   strands = 20       on = "box"
const SystemKind& tress_kind();

/// What a tress turns by in a frame [rad of phase].
inline constexpr double k_tress_step = 0.25;

}  // namespace ft::test

// A kind of secondary for tests: [swarm.NAME], tokens that fly about and turn, each by what it did before, so that a
// resume from the wrong state shows. They are instances: what the conductor does with a shape that is no mesh.
#pragma once

#include "baker/systems/interface/system.h"

namespace ft::test {

struct SwarmSpec final : SecondarySpec {
  int count = 12;       ///< tokens
  int spoilt = 0;       ///< in this frame a token has no place; 0: never
  double nudge = 0;     ///< of the first token's start [m]
  bool turned = false;  ///< the tokens stand in the opposite order
  int first_id = 100;
};

/// Sections:
///   [swarm.NAME]
///   count = 12         on = "box"
const SystemKind& swarm_kind();

/// Two prototypes, a bent square and a triangle; of ids the higher ones first.
SystemShape swarm_shape(const SwarmSpec& spec);

}  // namespace ft::test

// What a solver is besides that takes primaries along which are not its collider: balls that float in its water.
#pragma once

#include <span>
#include <string_view>

#include "baker/core/state.h"

namespace ft::inline solvers {

class MovesPrimaries {
 public:
  virtual ~MovesPrimaries() = default;
  /// Whether a primary goes where the solver takes it; else along its trajectory.
  virtual bool moves(std::string_view primary) const = 0;
  /// Of one that it moves, in the vertex order of its surface [m].
  virtual void moved_positions(const State& state, std::string_view primary, std::span<Vec3> positions) const = 0;
};

}  // namespace ft::inline solvers

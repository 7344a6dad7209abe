// How a liquid flows at the vertices of its surface, beside the Trajectory that says where they are: vertices of such a
// surface stand over fixed places, so that their own motion does not tell where the liquid goes.
#pragma once

#include <span>

#include "baker/core/types.h"

namespace ft {

/// Thread-safe: sampling changes nothing.
class VertexFlow {
 public:
  virtual ~VertexFlow() = default;
  /// One for each vertex [m/s]; time as Trajectory::sample.
  virtual void sample(double time, std::span<Vec3> velocities) const = 0;
};

}  // namespace ft

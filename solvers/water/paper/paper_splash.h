// Droplets: thrown up where a column rises faster than a threshold (O'Brien and Hodgins 1995), flying with the drag of
// the air, given back where they land. Their energy is taken from the pipes of their column, and no more than half of
// that; their momentum is lost where they land.
#pragma once

#include "baker/core/random.h"
#include "solvers/water/paper/pipes.h"

namespace ft::inline solvers {

/// What identifies a step's throws.
struct PaperThrow {
  std::uint64_t seed = 0, frame = 0, step = 0;
};

/// Takes droplets from columns that rose too fast in the step of dt that has just been; how many.
int throw_droplets(PipeWater& water, const UnderBodies& under, const PaperSplash& splash, const PaperThrow& when,
                   double dt, const Vec2& origin, std::uint64_t& next_id, std::vector<Droplet>& droplets);

/// Gives back what has come down, and takes it away. Returns the volume that came down outside [m3].
double land(std::vector<Droplet>& droplets, PipeWater& water, const Vec2& origin, double level_outside);

}  // namespace ft::inline solvers

// Droplets: thrown up where water rushes out from under a body, flying with the drag of the air, given back where they
// land. Each takes its volume from the column that it leaves, and with it that volume's momentum; it flies with no more
// than that, the rest is the body's, which turned it upwards.
#pragma once

#include "baker/core/random.h"
#include "solvers/water/shallow/near_water.h"

namespace ft::inline solvers {

/// What identifies a throw: nothing random depends on threads or on how often a step was tried.
struct SplashTime {
  std::uint64_t seed = 0, frame = 0, step = 0;
};

/// After step_depths(), before finish_step(): takes droplets from `flow` at the rims of what `near` covers, for at most
/// `most` of them.
void throw_droplets(Flow& flow, const NearWater& near, const ShallowSplash& splash, const SplashTime& time,
                    double world_x, double world_z, double pressure_speed, double dt, std::size_t most,
                    std::uint64_t& next_id, std::vector<Droplet>& droplets);

/// Gives back to the flow what has come down on it, volume and momentum, and takes those away. Returns the volume that
/// came down outside [m3].
double land(std::vector<Droplet>& droplets, Flow& flow, double world_x, double world_z, double level_outside);

}  // namespace ft::inline solvers

// How droplets fly: by their weight and the drag of the air, as balls; bodies stop them.
#pragma once

#include "solvers/water/droplet_bodies.h"

namespace ft::inline solvers {

struct DropletAir {
  double density = 1.2;  ///< kg/m3
  double drag = 0.47;    ///< coefficient of a droplet [1]; 0 flies as in a vacuum
};

/// Moves all on by dt [s]. density: of the water [kg/m3]. bodies: set to the same step.
void fly(std::vector<Droplet>& droplets, const DropletAir& air, double gravity, double density, double dt,
         DropletBodies& bodies);

}  // namespace ft::inline solvers

// How droplets fly: by their weight and the drag of the air, as balls. They pass through bodies.
#pragma once

#include "solvers/water/water_body.h"

namespace ft::inline solvers {

struct DropletAir {
  double density = 1.2;  ///< kg/m3
  double drag = 0.47;    ///< coefficient of a droplet [1]; 0 flies as in a vacuum
};

/// Moves all on by dt [s]. density: of the water [kg/m3].
void fly(std::vector<Droplet>& droplets, const DropletAir& air, double gravity, double density, double dt);

}  // namespace ft::inline solvers

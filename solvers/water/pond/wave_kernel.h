// How wide a floating body presses on the waves: kernels over q = k d, where d = (volume + added mass / density) /
// waterplane area is the depth at which a long wave acts on it (a hemisphere's radius).
//
// Heave: that of a floating hemisphere, from Hulme's (1982) damping B and added mass A. The pairing of our waves with
// a body whose displaced volume follows the level around it, V = V(z - <phi, eta>), is linear theory exactly when
//   phi = psi / |1 + c|,  psi^2 = 4 B / (3 pi q),  c = -2/3 q (A - 1/2) + 2/3 i q B   (B, A normalised as Hulme's)
// because <phi, eta> holds what the body itself has pushed up: 1 / (1 - c_phi) = 1 + c_psi.
// Surge: exp(-0.745 q), whose memory is the added mass that a hemisphere gains from fast to slow motion (0.273 to 0.5).
#pragma once

#include <vector>

#include "solvers/water/pond/pond_modes.h"

namespace ft::inline solvers {

double heave_kernel(double q);
double surge_kernel(double q);

/// Kernels of one d on all waves of a pond, cut softly where the grid ends.
struct KernelTable {
  KernelTable(const PondModes& modes, double depth);
  double depth = 0;        ///< d [m]
  double self_level = 0;   ///< <phi, phi> without walls: level at the body by its own volume [1/m2]
  std::vector<float> phi;  ///< heave
  std::vector<float> chi;  ///< surge
};

}  // namespace ft::inline solvers

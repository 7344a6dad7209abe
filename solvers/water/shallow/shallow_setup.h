// What a shot says of shallow water: the ground it stands on, its edges, what floats in it, how it splashes.
// Water lies over x and z; y is up. See shallow_solver.h for what the solver does.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "solvers/water/water_body.h"

namespace ft::inline solvers {

/// What an edge of the domain does.
enum class ShallowEdge {
  k_wall,  ///< nothing passes
  k_open,  ///< waves leave; beyond it the water stands as it stood along the edge at the start, a dry edge pours over
};

/// Droplets thrown up at the rim of a body that presses on the water.
struct ShallowSplash {
  bool on = true;
  double share = 0.25;         ///< of what rushes out fastest, that flies [1]. 0.15 low splash, 0.25 measured; 0 to 1
  double threshold = 1.5;      ///< outward speed at the rim from which water flies [m/s]; 1.5 to 2 usual
  double smallest = 2e-3;      ///< diameter [m]; > 0
  double largest = 6e-3;       ///< diameter [m]; at least the smallest
  int most_droplets = 200000;  ///< in the air at once; what would fly beyond that stays in the water
  double air_density = 1.2;    ///< kg/m3
  double drag = 0.47;          ///< coefficient of a droplet [1]; 0 flies as in a vacuum
};

using ShallowFloat = PlacedFloat;

struct ShallowSetup {
  std::string name = "water";
  Vec2 origin = Vec2::Zero();          ///< least x and least z of the domain [m]
  double cell = 0.01;                  ///< m; 2.5e-3 to 0.05 usual
  int nx = 0, nz = 0;                  ///< cells, 1 or more
  std::vector<double> bed;             ///< height of the ground in each cell, x fastest [m]; empty: flat at 0
  double level = 0;                    ///< of the water at the start; where the bed is higher it is dry [m]
  std::vector<double> depth;           ///< at the start, per cell; empty: as the level says [m]
  std::array<ShallowEdge, 4> edges{};  ///< at least x, most x, least z, most z
  double gravity = k_gravity;          ///< m/s2, downwards
  double density = 1000;               ///< kg/m3
  double manning = 0.012;   ///< roughness of the bed [s/m^(1/3)]. 0 none, 0.010 glass, 0.013 concrete, 0.03 gravel
  double viscosity = 1e-6;  ///< kinematic [m2/s]: laminar friction 3 nu/h2, which holds thin films. 0 none
  double cfl = 0.25;        ///< cells that water may go in a step, and half of what waves go [1]; to 0.33
  /// The largest pressure between a driven body and the ground or the water under it [Pa]: what a foot's sole bears
  /// (2.3 kN on 0.0234 m2). It sets how fast the rim goes, sqrt(2 p/density).
  double contact_pressure = 98e3;
  double drying_time = 60;  ///< of ground that was wet, to 1/e of its mark [s]
  std::uint64_t seed = 1;
  ShallowSplash splash;
  std::vector<ShallowFloat> floats;
  double memory_limit = 4e9;  ///< bytes that all cells may need
};

/// All that is wrong with a setup, in one error; or nothing.
Status check_shallow_setup(const ShallowSetup& setup);

/// Bytes that a domain of so many cells needs.
double shallow_memory(int nx, int nz);

}  // namespace ft::inline solvers

// What a shot says of the water of the paper: the ground it stands on, its edges, what floats in it, how it splashes.
// Water lies over x and z; y is up. See paper_solver.h for what the solver does.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "solvers/water/droplet_flight.h"
#include "solvers/water/water_body.h"

namespace ft::inline solvers {

/// What an edge of the domain does.
enum class PaperEdge {
  k_wall,  ///< nothing passes
  k_open,  ///< waves leave; beyond it the water stands as it stood along the edge at the start, a dry edge pours over
};

/// Droplets thrown up where a column rises fast.
struct PaperSplash {
  bool on = true;
  double threshold = 1;        ///< a column that rises faster throws droplets [m/s]; 0.5 to 2 usual
  double share = 1;            ///< of what rises beyond that, that flies [1]; 0 to 1
  double fastest = 10;         ///< of a droplet as it leaves [m/s]
  double spread = 0.35;        ///< of droplets from upright, at most [rad]
  double smallest = 0;         ///< diameter [m]; 0: a tenth of a cell
  double largest = 0;          ///< diameter [m], at least the smallest; 0: two fifths of a cell
  int most_droplets = 100000;  ///< in the air at once; what would fly beyond that stays in the water
  DropletAir air;
};

struct PaperSetup {
  std::string name = "water";
  Vec2 origin = Vec2::Zero();        ///< least x and least z of the domain [m]
  double cell = 0.05;                ///< m
  int nx = 0, nz = 0;                ///< cells, 1 or more
  std::vector<double> bed;           ///< height of the ground in each cell, x fastest [m]; empty: flat at 0
  double level = 0;                  ///< of the water at the start; where the bed is higher it is dry [m]
  std::vector<double> depth;         ///< at the start, per cell; empty: as the level says [m]
  std::array<PaperEdge, 4> edges{};  ///< at least x, most x, least z, most z
  double gravity = k_gravity;        ///< m/s2, downwards
  double density = 1000;             ///< kg/m3
  double manning = 0;      ///< roughness of the bed [s/m^(1/3)]: 0 none, 0.010 glass, 0.013 concrete, 0.03 gravel
  double viscosity = 0;    ///< kinematic [m2/s]: laminar friction 3 nu/h2, which holds thin films; 0 none, 1e-6 water
  double cfl = 0.5;        ///< cells that the fastest wave goes in a step [1]; to 0.8
  double stiffness = 16;   ///< of columns under bodies: how much faster than in the open their head rises [1]; 2 to 100
  double driven_drag = 1;  ///< coefficient of the faces with which a driven body goes ahead [1]; 0 none
  std::uint64_t seed = 1;
  PaperSplash splash;
  std::vector<PlacedFloat> floats;
  double memory_limit = 4e9;  ///< bytes that all cells may need
};

/// All that is wrong with a setup, in one error; or nothing.
Status check_paper_setup(const PaperSetup& setup);

/// Bytes that a domain of so many cells needs.
double paper_memory(int nx, int nz);

}  // namespace ft::inline solvers

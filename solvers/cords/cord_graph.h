// Nets, ropes and chains as the solver sees them: points joined by straight cords. Nothing here moves.
#pragma once

#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft {

struct CordGraph {
  std::vector<Vec3> points;               ///< at rest [m]
  std::vector<Edge> cords;                ///< straight pieces between points, each once
  std::vector<std::vector<int>> strands;  ///< runs of points that are drawn as one tube; every cord in one of them
  std::vector<int> held;                  ///< points that are tied to the world, ascending: a net's top loops
  std::vector<double> heavier;            ///< per point: its share of mass beyond the cords', relative; empty: none
};

}  // namespace ft

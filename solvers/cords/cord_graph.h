// Nets, ropes and chains as the solver sees them: points joined by straight cords. Nothing here moves.
#pragma once

#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline solvers {

struct CordGraph {
  std::vector<Vec3> points;               ///< at rest [m]
  std::vector<Edge> cords;                ///< straight pieces between points, each once
  std::vector<std::vector<int>> strands;  ///< runs of points that are drawn as one tube; every cord in one of them
  std::vector<int> held;                  ///< points that are tied to the world, ascending: a net's top loops
  std::vector<double> heavier;  ///< per point: mass beyond the cords', in units of the mass of all cords; empty: none
};

/// Joins points `a` and `b` by `pieces` >= 1 cords of one length, with new points between them.
void add_side(CordGraph& graph, int a, int b, int pieces);

/// Fills in `strands`: cords that run on into each other through a point, the straightest pairs first, none that turn
/// by more than 75 degrees. A strand begins at a held point where one of its ends is held.
void join_strands(CordGraph& graph);

/// Mass of each point [kg], of `total` > 0: half of each cord's, by length, and `heavier` in units of all cords' mass.
std::vector<double> lumped_masses(const CordGraph& graph, double total);

}  // namespace ft::inline solvers

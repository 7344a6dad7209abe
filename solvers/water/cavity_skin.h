// How the mesh of a surface, a grid, goes down into cavities and keeps its faces. The vertices around a cavity are
// drawn in, square by square: those of a square come to lie on a circle that narrows towards the cavity and goes down
// its wall to the bottom, and the middle of the squares is the bottom's. Drawn-in vertices slide along the surface as
// the cavity grows, without jumps; a surface that has closed is drawn into its air below by a neck of no width.
#pragma once

#include <span>
#include <vector>

#include "solvers/water/water_core.h"

namespace ft::inline solvers {

/// A vertex that is not above its place on the grid.
struct DrawnIn {
  std::size_t vertex = 0;
  Vec3 place = Vec3::Zero();  ///< m
  bool on_wall = false;       ///< of a cavity; else on the surface around it
};

/// heights: of the vertices of water_mesh() where there were no cavities [m]. Of cavities whose surroundings overlap
/// the longest is drawn, and none that is too near to the rim for its size.
std::vector<DrawnIn> draw_in(const WaterGrid& grid, std::span<const double> heights,
                             std::span<const WaterCavity> cavities);

/// A value of the grid's vertices, linear between them; x, z: brought onto the grid.
template <class Value>
Value between_vertices(const WaterGrid& grid, std::span<const Value> values, double x, double z) {
  const double u = std::clamp((x - grid.origin.x()) / grid.cell, 0.0, static_cast<double>(grid.nx)),
               w = std::clamp((z - grid.origin.y()) / grid.cell, 0.0, static_cast<double>(grid.nz));
  const int i = std::min(static_cast<int>(u), grid.nx - 1), k = std::min(static_cast<int>(w), grid.nz - 1);
  const double a = u - i, b = w - k;
  const std::size_t row = static_cast<std::size_t>(grid.nx) + 1;
  const std::size_t v = static_cast<std::size_t>(k) * row + static_cast<std::size_t>(i);
  return Value((1 - b) * ((1 - a) * values[v] + a * values[v + 1]) +
               b * ((1 - a) * values[v + row] + a * values[v + row + 1]));
}

}  // namespace ft::inline solvers

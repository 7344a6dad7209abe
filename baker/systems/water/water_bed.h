// The ground under shallow water, from a mesh.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "solvers/water/water_core.h"

namespace ft::inline baker {

struct WaterBed {
  std::vector<double> height;  ///< of each cell at its middle: the mesh's uppermost place there [m]
  int uncovered = 0;           ///< cells under which there is none; as high as the mesh's highest place
};

WaterBed bed_under(const WaterGrid& grid, std::span<const Vec3> positions, std::span<const Triangle> triangles);

/// Of still water at a level, how deep each cell is [m], without what runs off: cells below the level from which water
/// finds a way to the edge, over cells that are below it, too.
std::vector<double> depths_that_stay(const WaterGrid& grid, std::span<const double> bed, double level);

}  // namespace ft::inline baker

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

}  // namespace ft::inline baker

// Surface of a field, as triangles: naive surface nets (Gibson 1998) on a regular grid. Closed where the field is
// positive on the whole border of the grid, and two-manifold once separate_sheets() has filled the cells where two
// sheets would share a vertex.
#pragma once

#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

/// Values on the corners of nx * ny * nz points, x fastest; inside is negative.
struct FieldGrid {
  Vec3 origin = Vec3::Zero();
  double spacing = 1;
  int nx = 0, ny = 0, nz = 0;
  std::vector<double> values;
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(nx) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(z));
  }
  Vec3 point(int x, int y, int z) const { return origin + spacing * Vec3(x, y, z); }
};

struct NetSurface {
  std::vector<Vec3> positions;
  std::vector<std::array<int, 4>> quads;  ///< counter-clockwise seen from outside
};

/// Fills corners until every cell holds one piece of surface: inside and outside corners each connected along the
/// cell's edges, no face with diagonal signs. Narrow gaps close; nothing opens. Border values stay.
void separate_sheets(FieldGrid& grid);

NetSurface surface_nets(const FieldGrid& grid);

}  // namespace ft::inline io

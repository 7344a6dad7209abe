// Which stretches of the columns over a rectangle of cells are inside bodies, from their triangles. Each cell has 4 x 4
// columns. Shells that overlap are one (winding above zero is inside); a surface that is open at the top, as a leg that
// is cut above the water, has no top; tops without a bottom are passed over.
#pragma once

#include <span>
#include <vector>

#include "solvers/water/water_body.h"

namespace ft::inline solvers {

inline constexpr int k_columns = 4;                             ///< along one side of a cell
inline constexpr int k_columns_a_cell = k_columns * k_columns;  ///< of a cell

/// Inside a body along one column: heights [m], whose body it is there, and the surface's slope as n / n.y, whose x and
/// z are here, cut at k_steepest. One without a top has it at infinity.
struct ColumnSpan {
  double bottom = 0, top = 0;
  float bottom_x = 0, bottom_z = 0, top_x = 0, top_z = 0;
  short bottom_body = 0, top_body = 0;
  short column = 0;  ///< of its cell, 0 to 15
};

inline constexpr double k_steepest = 25;

/// A surface in the world; triangles wholly above `ceiling` may be left out of it.
struct BodySurface {
  std::span<const Triangle> triangles;
  std::span<const Vec3> positions;  ///< m
};

/// A rectangle of cells in the world.
struct ColumnGrid {
  double x = 0, z = 0;  ///< its least x and z [m]
  double cell = 0;      ///< m
  int nx = 0, nz = 0;
};

/// Spans of the rectangle's cells: cell (i, k) has those from start[i + nx k] on, up to start of the next; of a cell by
/// column, of a column upwards.
struct BodyColumns {
  std::vector<int> start;
  std::vector<ColumnSpan> spans;

  /// Scratch.
  struct Hit {
    double height;
    float slope_x, slope_z;
    int column;
    short body, enters;
  };
  std::vector<Hit> hits, sorted;
  std::vector<int> column_start;

  /// From surfaces, one a body; what is above `ceiling` [m] is of no interest.
  void find(const ColumnGrid& grid, std::span<const BodySurface> bodies, double ceiling);
};

}  // namespace ft::inline solvers

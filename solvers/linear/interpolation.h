// Coarse vertices for multigrid on any mesh: an independent set of the matrix pattern, and for every other vertex the
// triangle (or pair) of nearby coarse vertices around it with its barycentric weights in the rest shape. Linear fields
// of the rest shape are reproduced wherever a coarse triangle encloses the vertex, which stiff bending needs. Built
// once; weights are scalars.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"

namespace ft {

struct Interpolation {
  /// Up to three coarse vertices per fine vertex (-1: unused); weights >= 0 that sum to 1.
  struct Row {
    std::array<int, 3> coarse{-1, -1, -1};
    std::array<float, 3> weight{0, 0, 0};
  };
  std::vector<Row> rows;
  std::vector<int> coarse_to_fine;  ///< the fine vertex that each coarse one is
  int coarse_count() const { return static_cast<int>(coarse_to_fine.size()); }
};

/// rest: one position per row of the pattern [m].
Interpolation make_interpolation(const BlockPattern& pattern, std::span<const Vec3> rest);

}  // namespace ft

// Coarse vertices for multigrid on any mesh: an independent set of the matrix pattern, and for every other vertex the
// triangle (or pair) of nearby coarse vertices around it with its barycentric weights in the rest shape. Linear fields
// of the rest shape are reproduced wherever a coarse triangle encloses the vertex, which stiff bending needs. Built
// once; weights are scalars, counted in shares so that the products of any two are whole numbers of few bits
// (galerkin_plan.h) and still sum to one exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"

namespace ft::inline solvers {

struct Interpolation {
  /// Of a fine vertex. Supports are met to a hundredth of their distance, and exactly in regular meshes, where weights
  /// are halves, thirds and quarters: with 63 a sheet that flies loses ten times the momentum to the linear solver.
  static constexpr int k_shares = 60;
  static constexpr float k_share = 1.f / k_shares;
  /// Of the fine vertex or the coarse one at its other end; vertices are below k_most_vertices.
  struct Link {
    std::uint32_t vertex : 26;
    std::uint32_t share : 6;
    float weight() const { return k_share * static_cast<float>(share); }
  };
  static constexpr int k_most_vertices = 1 << 26;
  static_assert(k_shares < 1 << 6);
  /// Up to three coarse vertices per fine vertex; shares > 0 that sum to k_shares (0: unused, and all behind it).
  using Row = std::array<Link, 3>;
  std::vector<Row> rows;
  std::vector<int> coarse_to_fine;  ///< the fine vertex that each coarse one is
  /// The same by columns: fine vertices of each coarse one, ascending.
  std::vector<int> children_start;
  std::vector<Link> children;
  int coarse_count() const { return static_cast<int>(coarse_to_fine.size()); }
};

/// rest: one position per row of the pattern [m].
Interpolation make_interpolation(const BlockPattern& pattern, std::span<const Vec3> rest);

}  // namespace ft::inline solvers

// Columns of water over x and z, each joined to its eight neighbours by pipes (O'Brien and Hodgins 1995). A pipe of
// cross-section A and length l between columns whose heads differ by d carries Q,
//   dQ/dt = A g d / l,   d depth/dt = sum of Q / cell^2,
// with A = (2/3) H cell, l = cell along the axes and A = (sqrt 2/6) H cell, l = sqrt 2 cell across the corners, by
// which waves run alike in all directions and as fast as sqrt(g H). A column never gives more than it has. Water
// carries no momentum along: bores and dam breaks are wrong.
#pragma once

#include <array>
#include <vector>

#include "solvers/water/paper/paper_setup.h"
#include "solvers/water/paper/under_bodies.h"

namespace ft::inline solvers {

/// Pipes of a cell: to its neighbours at more x, more z, more of both, less x and more z.
inline constexpr std::size_t k_pipes = 4;

class PipeWater {
 public:
  explicit PipeWater(const PaperSetup& setup);

  const int nx, nz;
  const double cell;
  std::vector<double> bed, depth;                    ///< m
  std::array<std::vector<double>, k_pipes> carries;  ///< m3/s, away from the cell; 0 where there is no pipe
  std::vector<double> head;                          ///< m; find_heads()
  std::vector<double> rise;                          ///< of depths in the last step [m/s]

  std::size_t of(int i, int k) const { return at(i) + at(nx) * at(k); }
  ColumnsMet met() const { return {origin_, cell, nx, nz, bed, depth}; }
  double deepest() const;
  double highest() const;  ///< of the water's surfaces [m]

  /// From depths, and what presses on them.
  void find_heads(UnderBodies& under);
  /// Pipes by the heads, depths by the pipes; returns what has left over the edges [m3].
  double step(const UnderBodies& under, double dt);
  /// Mean over the depth [m/s]; 0 in films.
  Vec2 velocity(std::size_t c) const;
  double kinetic(const UnderBodies& under) const;  ///< over density [m5/s2]
  /// Of the eight pipes of a cell, as kinetic().
  double kinetic_of(const UnderBodies& under, std::size_t c) const;
  /// Takes a share of that energy out of the eight pipes of a cell; 0 to 1.
  void slow(std::size_t c, double share);

 private:
  struct Pipe {
    double share = 0;  ///< A / (l H)
    double depth = 0;  ///< H [m]
    double drop = 0;   ///< of the heads along it [m]
  };
  double energy(const UnderBodies& under, int i, int k, std::size_t way) const;
  Pipe pipe(const UnderBodies& under, int i, int k, std::size_t way) const;
  double edge_flow(std::size_t side, std::size_t c) const;

  Vec2 origin_;
  std::array<PaperEdge, 4> edges_;
  std::vector<double> outside_;  ///< level beyond open edges, of their cells [m]
  double gravity_, manning_, viscosity_;
  std::vector<double> scale_;
};

}  // namespace ft::inline solvers

// Columns of water under and in bodies: what a body takes of a column presses on it as an external pressure, the weight
// of the water that it displaces there,
//   P = density g (1 - 1/stiffness) s(head),   head = ground + depth + P / (density g),
// where s is the mean thickness of bodies below the head. Where a body covers a column the head rises by `stiffness`
// times what is pressed in, so that the head is defined everywhere and explicit steps are stable. The same heads, as
// pressure on its surface, push the body: equal and opposite up to 1/stiffness, for which float_force() stands in with
// the water's level around it; so a body at rest displaces its own weight exactly.
#pragma once

#include <span>
#include <vector>

#include "baker/core/wrench.h"
#include "solvers/water/body_columns.h"

namespace ft::inline solvers {

/// The columns of water as bodies meet them.
struct ColumnsMet {
  Vec2 origin = Vec2::Zero();  ///< least x and z [m]
  double cell = 0;             ///< m
  int nx = 0, nz = 0;
  std::span<const double> bed, depth;  ///< of each cell, x fastest [m]
};

/// Scratch of one step.
class UnderBodies {
 public:
  struct Cell {
    std::size_t c = 0;
    int begin = 0, end = 0;  ///< spans
  };

  /// Which columns are in bodies. Bodies wholly above `ceiling` [m] are nowhere.
  void find(const ColumnsMet& water, std::span<const BodySurface> bodies, double ceiling, double stiffness);
  std::span<const Cell> cells() const { return cells_; }
  /// Number of a cell, -1 where there is no body.
  int of(std::size_t c) const { return of_[c]; }

  /// Thickness of water in a cell at a head [m]; soft: with the give of the stiffness.
  double holds(int cell, double head, bool soft) const;
  /// The head at which a cell holds so much [m].
  double head_of(int cell, double depth);
  /// Whether bodies stand on all of a cell's water at a head, none of it open.
  bool covered(int cell, double head) const;
  /// Integral of head over depth, from an empty cell to a head [m2].
  double work(int cell, double head) const;

  /// On each body [N], torques about the world's origin; with `level` in place of all heads if given.
  void forces(std::span<const double> head, double weight, const double* level, int only, std::span<Wrench> out) const;
  /// Mean head of the free columns around a body, of all around it where none is free; false: no water is there.
  bool level_around(int body, std::span<const double> head, double& level) const;
  struct Rectangle {
    int i0 = 0, k0 = 0, i1 = 0, k1 = 0;  ///< without the last
    bool empty() const { return i0 >= i1 || k0 >= k1; }
  };
  Rectangle rectangle(int body) const { return boxes_[at(body)]; }

 private:
  ColumnsMet water_;
  double softness_ = 0;
  std::vector<int> of_;
  std::vector<Cell> cells_;
  std::vector<ColumnSpan> spans_;
  std::vector<Rectangle> boxes_;
  BodyColumns columns_;
  std::vector<std::pair<double, double>> turns_;  ///< heights at which the slope of what a cell holds changes
};

}  // namespace ft::inline solvers

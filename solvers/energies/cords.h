// Cords: a point of the cloth is drawn to another along the line between them; what is nearer than the cord is long
// feels nothing.
//   U = sum of the integral of f(e), e = |sum w_k x_k| - L,   f = min(k e, limit), 0 where e < 0;   sum w_k = 0
// Only the distance counts: the ends feel equal and opposite forces along one line, so neither momentum nor spin comes
// from a cord. Hessian: with the secant f / e along it, which is the true one as long as the limit is not reached and
// above it beyond.
#pragma once

#include <vector>

#include "solvers/energies/block_positions.h"
#include "solvers/energies/energy.h"

namespace ft::inline solvers {

/// A vertex at the first place, weight 1; the others are a point of an edge or a triangle with weights below 0.
struct Cord {
  std::array<int, 4> vertex{-1, -1, -1, -1};  ///< -1: unused
  std::array<double, 4> weight{};             ///< sums to 0
  double length = 0;                          ///< m
  double stiffness = 0;                       ///< N/m; 0: it does not hold
  double limit = 0;                           ///< N
};

/// Who derives says in begin_step() how long and how strong the cords are.
class Cords : public Energy {
 public:
  std::vector<std::array<int, 4>> stencils() const override;
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;

 protected:
  explicit Cords(std::vector<Cord> cords);
  std::vector<Cord> cords_;

 private:
  mutable BlockPositions<4> positions_;
};

}  // namespace ft::inline solvers

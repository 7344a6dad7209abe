// The linear system of the heads near bodies: a symmetric five-point matrix over an irregular set of cells, with a few
// dense directions (the bodies that the water moves) added. Conjugate gradients, preconditioned by a modified
// incomplete Cholesky factor (Bridson 2015, 5.4) of the five-point part; one thread, cells in their order.
#pragma once

#include <array>
#include <vector>

#include "solvers/water/water_body.h"

namespace ft::inline solvers {

struct NearSystem {
  /// Rows: neighbours at lower x, higher x, lower z, higher z; -1 where there is none. Lower ones come earlier.
  std::vector<std::array<int, 4>> neighbour;
  std::vector<double> diagonal;
  std::vector<std::array<double, 4>> coupling;  ///< >= 0; the matrix has their negative

  /// scale * directions * block * directions^T of each body is added.
  struct Body {
    std::vector<int> rows;
    std::vector<Vec6> directions;
    Mat6 block = Mat6::Zero();  ///< symmetric, not negative
  };
  std::vector<Body> bodies;

  /// Of the last solve.
  int iterations = 0;

  /// x from 0, until the residual's largest entry is below `tolerance`.
  void solve(const std::vector<double>& right, double tolerance, std::vector<double>& x);

 private:
  void factor();
  void precondition(const std::vector<double>& r, std::vector<double>& z) const;
  void multiply(const std::vector<double>& p, std::vector<double>& out) const;

  std::vector<double> pivot_, r_, z_, p_, q_;
};

}  // namespace ft::inline solvers

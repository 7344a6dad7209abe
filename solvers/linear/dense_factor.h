// The coarsest level of a hierarchy, solved by a dense Cholesky factor in double: of so few vertices it costs less than
// a sweep of the finest.
#pragma once

#include <Eigen/Cholesky>

#include "solvers/linear/level.h"

namespace ft::inline solvers {

class DenseFactor {
 public:
  /// Of the level's matrix, with a millionth more on its diagonal, and something where that is zero: rows that are
  /// held. None where the level is too large, or its matrix not positive definite.
  void build(const Level& level);
  bool exists() const { return exists_; }
  /// x = A^-1 b, both of the level that it was built of.
  void solve(Level& level) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
  bool exists_ = false;
};

}  // namespace ft::inline solvers

#include "solvers/linear/dense_factor.h"

#include <algorithm>

namespace ft::inline solvers {
namespace {

constexpr int k_most_vertices = 400;  ///< above it the coarsest level is only smoothed

}  // namespace

void DenseFactor::build(const Level& level) {
  exists_ = false;
  if (level.size() > k_most_vertices) return;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * level.size(), 3 * level.size());
  for (int i = 0; i < level.size(); ++i)
    for (int k = level.pattern->diagonal[at(i)]; k < level.pattern->diagonal[at(i) + 1]; ++k) {
      const int j = level.pattern->column[at(k)];
      const Mat3 block = level.matrix.blocks[at(k)].cast<double>();
      dense.block<3, 3>(3 * i, 3 * j) = block;
      if (j > i) dense.block<3, 3>(3 * j, 3 * i) = block.transpose();
    }
  const double largest = dense.diagonal().maxCoeff();
  for (int i = 0; i < dense.rows(); ++i) dense(i, i) += dense(i, i) > 0 ? 1e-6 * dense(i, i) : std::max(largest, 1.0);
  factor_.compute(dense);
  exists_ = factor_.info() == Eigen::Success;
}

void DenseFactor::solve(Level& level) const {
  Eigen::VectorXd b(3 * level.size());
  for (int i = 0; i < level.size(); ++i) b.segment<3>(3 * i) = level.b[at(i)].head<3>().cast<double>();
  factor_.solveInPlace(b);
  for (int i = 0; i < level.size(); ++i) level.x[at(i)] << b.segment<3>(3 * i).cast<float>(), 0;
}

}  // namespace ft::inline solvers

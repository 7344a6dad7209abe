// What a linear system keeps between calls. Part of linear_system.cpp and linear_cycle.cpp.
#pragma once

#include <memory>
#include <vector>

#include "solvers/linear/dense_factor.h"
#include "solvers/linear/extra_rows.h"
#include "solvers/linear/level.h"
#include "solvers/linear/linear_system.h"

namespace ft::inline solvers {

/// Of what the preconditioner makes of the residual.
struct Products {
  double with_residual, with_product;  ///< product: of the matrix and the last direction
  /// Of the residual, near the energy of the error, never negative: what the coarse correction meets of it, and the
  /// last smoothing step of the rest.
  double norm_squared;
};

/// The same, while they are summed up over vertices.
struct ProductLanes {
  using Lanes = Eigen::Array4d;
  Lanes with_residual = Lanes::Zero(), with_product = Lanes::Zero(), norm_squared = Lanes::Zero();
  Vec3 sums() const { return {with_residual.sum(), with_product.sum(), norm_squared.sum()}; }
};

struct LinearSystem::Impl {
  LinearSettings settings;
  std::vector<std::unique_ptr<Level>> levels;
  DenseFactor coarsest;  ///< of the last level, if it is not the finest
  std::vector<ExtraBlock> added;
  std::vector<StiffClusters::Coupling> couplings;  ///< of the terms, in the pattern
  std::vector<char> held;
  std::vector<Vec4f> direction;
  /// Of the matrix and the direction; then M^-1 residual, of which every entry wants that of the product alone.
  std::vector<Vec4f> product;
  std::vector<Vec3f> solution, best;  ///< best: where later ones are worse
  bool symmetric = false;             ///< the finest level smooths before the correction too, or there is no correction
  float alpha = 0;                    ///< of the last step: the residual has lost so much of product

  Level& fine() { return *levels.front(); }
  std::vector<Vec4f>& preconditioned() { return product; }
  void hold(std::span<const char> fixed);
  void refresh_hierarchy();
  bool start(std::span<const Vec3> right_side);
  bool step(double rz);
  void advance(float beta);
  void correct(std::size_t depth);
  Products precondition(double most_norm_squared);
  void take(std::size_t i, const Vec4f& z, ProductLanes& lanes);
  void take_smoothed(std::size_t i, const Vec4f& rest, const Vec4f& by_rest, ProductLanes& lanes);
  Products apply_cycle();
  Products apply_jacobi();
};

}  // namespace ft::inline solvers

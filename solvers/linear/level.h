// One level of the multigrid hierarchy: matrix in 3x3 float blocks, damped block-Jacobi smoother, and the plan that
// gathers the next coarser (Galerkin) matrix block by block without a search, in a fixed order.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solvers/linear/interpolation.h"

namespace ft {

using Vec4f = Eigen::Vector4f;  ///< a 3-vector padded for aligned loads; the fourth entry is always zero or ignored

struct Level {
  const BlockPattern* pattern = nullptr;
  BlockPattern own_pattern;    ///< of coarse levels
  std::vector<float> blocks;   ///< 9 per block, column by column, one block of padding at the end
  std::vector<Mat3f> inverse;  ///< of the diagonal blocks; zero for rows that are held
  float damping = 0.45f;       ///< of the smoother: below 2 / largest eigenvalue of D^-1 A
  std::vector<Vec3> rest;
  std::vector<Vec4f> x, r, b;

  // Towards the next level (absent on the coarsest).
  Interpolation interpolation;
  std::vector<int> children_start, children;  ///< fine vertices of each coarse one, ascending
  std::vector<float> children_weight;
  struct Contribution {
    int block;
    float weight;
  };
  std::vector<int> gather_start;  ///< per coarse block of the upper triangle
  std::vector<Contribution> gather;
  std::vector<int> upper, lower;  ///< positions in the coarse matrix that each gathered block goes to

  int size() const { return pattern->vertex_count(); }
};

/// Interpolation, coarse pattern and gather plan; false when coarsening gains too little.
bool link_levels(Level& fine, Level& coarse);
/// coarse.blocks = P^T fine.blocks P.
void galerkin(const Level& fine, Level& coarse);
/// Inverts the diagonal blocks; singular ones (held rows) get zero.
void invert_diagonal(Level& level);
/// Damping from a few power steps on a fixed start vector.
void estimate_damping(Level& level);
/// y = A x.
void multiply(const Level& level, std::span<const Vec4f> x, std::span<Vec4f> y);
/// r = b - A x.
void residual(const Level& level, std::span<const Vec4f> x, std::span<const Vec4f> b, std::span<Vec4f> r);
/// coarse b = P^T fine r.
void restrict_residual(const Level& fine, Level& coarse);
/// fine x += P coarse x.
void prolong(Level& fine, const Level& coarse);

}  // namespace ft

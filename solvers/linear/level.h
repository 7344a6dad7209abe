// One level of the multigrid hierarchy: matrix in 3x3 float blocks, damped block-Jacobi smoother, and the plan that
// gathers the next coarser (Galerkin) matrix block by block without a search, in a fixed order.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"
#include "solvers/linear/extra_rows.h"
#include "solvers/linear/interpolation.h"
#include "solvers/linear/packed_rows.h"

namespace ft {

/// A 3x3 block, columns padded with zeros.
struct PaddedBlock {
  Vec4f columns[3] = {Vec4f::Zero(), Vec4f::Zero(), Vec4f::Zero()};

  PaddedBlock() = default;
  explicit PaddedBlock(const Mat3f& block) {
    for (int c = 0; c < 3; ++c) columns[c].head<3>() = block.col(c);
  }
  Vec4f operator*(const Vec4f& v) const { return columns[0] * v[0] + columns[1] * v[1] + columns[2] * v[2]; }
  float trace() const { return columns[0][0] + columns[1][1] + columns[2][2]; }
};

struct Level {
  const BlockPattern* pattern = nullptr;
  BlockPattern own_pattern;  ///< of coarse levels
  BlockMatrix matrix;
  PackedRows rows;                   ///< of the matrix, for products
  ExtraRows extra;                   ///< of the finest: what contacts couple besides
  std::vector<PaddedBlock> inverse;  ///< of the diagonal blocks; zero for rows that are held
  float damping = 0.45f;             ///< of the smoother: below 2 / largest eigenvalue of D^-1 A
  std::vector<Vec3> rest;
  std::vector<Vec4f> x, r, b;
  std::vector<Vec4f> probe;  ///< where estimate_damping() starts; not of the finest, whose damping is given

  // Towards the next level (absent on the coarsest).
  Interpolation interpolation;
  std::vector<int> children_start, children;  ///< fine vertices of each coarse one, ascending
  std::vector<float> children_weight;
  struct Contribution {
    int place;
    float weight;
  };
  std::vector<int> gather_start;  ///< two per coarse block: of the blocks that come as they are, and transposed
  std::vector<Contribution> gather;

  int size() const { return pattern->vertex_count(); }
  /// Places for everything above, once the pattern is known.
  void build();
  /// Row times v, with what is extra.
  Vec4f product(std::size_t row, std::span<const Vec4f> v) const;
};

// Inlined always: the call costs a tenth of the sweeps that it stands in.
[[gnu::always_inline]] inline Vec4f Level::product(std::size_t row, std::span<const Vec4f> v) const {
  Vec4f sum = rows.product(row, v.data());
  if (!extra.value.empty())
    for (int k = extra.start[row]; k < extra.start[row] + extra.used[row]; ++k)
      sum.head<3>() += extra.value[at(k)] * v[at(extra.column[at(k)])].head<3>();
  return sum;
}

/// Interpolation, coarse pattern and gather plan; false when coarsening gains too little.
bool link_levels(Level& fine, Level& coarse);
/// coarse.matrix = P^T fine.matrix P.
void galerkin(const Level& fine, Level& coarse);
/// Inverts the diagonal blocks; singular ones (held rows) get zero.
void invert_diagonal(Level& level);
/// Damping from a few power steps on a fixed start vector.
void estimate_damping(Level& level);
/// x = damping D^-1 b: a smoothing step from zero.
void smooth_first(Level& level);
/// x += damping D^-1 (b - A x); r is scratch.
void smooth(Level& level);
/// r = b - A x.
void residual(Level& level);
/// coarse b = P^T residual, which is of the fine level.
void restrict_to(Level& coarse, const Level& fine, std::span<const Vec4f> residual);
/// fine x = P coarse x.
void interpolate(Level& fine, const Level& coarse);
/// fine x += P coarse x.
void add_interpolated(Level& fine, const Level& coarse);

}  // namespace ft

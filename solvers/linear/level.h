// One level of the multigrid hierarchy: matrix in 3x3 float blocks, damped block-Jacobi smoother, and what leads to the
// next coarser level.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"
#include "solvers/linear/extra_rows.h"
#include "solvers/linear/galerkin_plan.h"
#include "solvers/linear/interpolation.h"
#include "solvers/linear/row_product.h"
#include "solvers/linear/stiff_clusters.h"

namespace ft::inline solvers {

/// A symmetric 3x3 block: xx, xy, xz, yy, yz, zz.
struct SymmetricBlock {
  std::array<float, 6> entries{};

  /// The fourth entry is zero.
  Vec4f operator*(const Vec4f& v) const {
    using namespace products;
    const Four low = load_four(entries.data()), high = load_four(entries.data() + 2);
    const Four first = low * v[0], second = __builtin_shufflevector(low, high, 1, 3, 6, 6) * v[1];
    const Four sum = first + second + __builtin_shufflevector(high, high, 0, 2, 3, 3) * v[2];
    Vec4f out;
    *reinterpret_cast<Four*>(out.data()) = __builtin_shufflevector(sum, Four{}, 0, 1, 2, 4);
    return out;
  }
  float trace() const { return entries[0] + entries[3] + entries[5]; }
};

struct Level {
  const BlockPattern* pattern = nullptr;
  BlockPattern own_pattern;  ///< of coarse levels
  float damping = 0.45f;     ///< of the smoother: below 2 / largest eigenvalue of D^-1 A
  std::vector<Vec4f> probe;  ///< where estimate_damping() starts; not of the finest, whose damping is given

  BlockMatrix matrix;
  ExtraRows extra;         ///< of the finest: what contacts couple besides
  StiffClusters clusters;  ///< of the finest: what the smoother takes as one

  // Of a solve.
  std::vector<SymmetricBlock> inverse;  ///< of the diagonal blocks; zero for rows that are held
  std::vector<Vec4f> x, b;
  std::vector<Vec4f> r;  ///< of the finest without room until its cycle is symmetric

  // Towards the next level (absent on the coarsest).
  Interpolation interpolation;
  GalerkinPlan plan;

  int size() const { return pattern->vertex_count(); }
  /// For the vectors of a solve, and of coarse levels r and the matrix; what is in them is not defined.
  void make_room();
  /// Frees all that.
  void give_back();
  /// Row times v, with what is extra.
  Vec4f product(std::size_t row, std::span<const Vec4f> v) const;
};

// Inlined always: the call costs a tenth of the sweeps that it stands in.
[[gnu::always_inline]] inline Vec4f Level::product(std::size_t row, std::span<const Vec4f> v) const {
  Vec4f sum = row_product(matrix, row, v.data());
  if (!extra.empty())
    for (int k = extra.start[row]; k < extra.start[row] + extra.used[row]; ++k)
      sum.head<3>() += extra.value[at(k)] * v[at(extra.column[at(k)])].head<3>();
  return sum;
}

/// Interpolation, plan and coarse pattern; false when coarsening gains too little. rest: a position per vertex of the
/// fine level [m], then of the coarse one.
bool link_levels(Level& fine, Level& coarse, std::vector<Vec3>& rest);
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

}  // namespace ft::inline solvers

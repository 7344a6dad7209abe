// Solves H dx = -g for one Newton step: flexible conjugate gradients with one multigrid cycle as preconditioner, V(0,1)
// on the finest level and V(1,1) below (hierarchy from the rest shape), or block Jacobi. What contact ties together is
// smoothed as one (stiff_clusters.h). Matrix, hierarchy and vectors in float, dot products accumulated in double.
// Deterministic for any thread count.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"

namespace ft::inline solvers {

struct LinearSettings {
  enum class Preconditioner { k_block_jacobi, k_multigrid };
  Preconditioner preconditioner = Preconditioner::k_multigrid;
  double tolerance = 1e-2;  ///< of the residual, as LinearReport has it; see tests/bench/RESULTS.md for what less buys
  int max_iterations = 200;
};

struct LinearReport {
  int iterations = 0;
  /// Relative, in the norm that the preconditioner makes of it, which is near the energy of the error: with stiff and
  /// soft parts in one system the plain norm sees the stiff ones alone.
  double residual = 0;
  double start_norm = 0;  ///< that norm of the right side [sqrt(J)]
  bool converged = false;
};

class LinearSystem {
 public:
  /// rest_positions and triangles shape the hierarchy; the pattern must outlive the system.
  LinearSystem(const BlockPattern& pattern, std::span<const Vec3> rest_positions, const LinearSettings& settings);
  ~LinearSystem();
  LinearSystem(const LinearSystem&) = delete;
  LinearSystem& operator=(const LinearSystem&) = delete;

  /// The matrix to fill: zeroed by begin(). Energies and the mass add to it.
  BlockMatrix& begin();
  /// Contact, friction and pins. Terms whose vertices share the pattern go into the matrix, the others are kept aside
  /// as an extra sparse block matrix (sorted, so that the sum order is fixed). After the energies; what comes in
  /// further calls is added.
  void add_pair_terms(std::span<const PairTerm> terms);
  /// Of a vertex alone, if all others stood still, along a unit vector [N/m].
  double stiffness_along(int vertex, const Vec3& direction) const;
  /// Rows of fixed[i] != 0 are held at zero, and leave the matrix for good: what is solved before it is filled anew may
  /// hold more of them, but not less.
  /// solution: room is made for it when the solve's own vectors are gone.
  /// enough: a residual that need not be made smaller, in the norm of LinearReport [sqrt(J)]: it stands for a tolerance
  /// of up to five times the settings', and of half of the right side at most.
  LinearReport solve(std::span<const Vec3> right_side, std::span<const char> fixed, std::vector<Vec3>& solution,
                     double enough = 0);
  /// Frees the matrices until the next begin(). What else a solve needs is there only while it runs.
  void give_back();
  bool is_filled() const;           ///< not since give_back()
  std::size_t block_count() const;  ///< of the matrix

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ft::inline solvers

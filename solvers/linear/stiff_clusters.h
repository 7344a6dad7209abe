// Vertices that contact ties together far more stiffly than anything else holds them, such as two edges of cloth with
// friction between them. Smoothed one by one they hardly move: what each may do alone is stiff, and only what they do
// together is soft, on no coarser level either. A cluster is smoothed as one, by the inverse of its own block of the
// matrix (block relaxation: Saad 2003, Iterative Methods for Sparse Linear Systems, 4.1.1; the damping for single
// blocks holds for any partition, for no element has more than four parts).
#pragma once

#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"
#include "solvers/linear/extra_rows.h"
#include "solvers/linear/row_product.h"

namespace ft::inline solvers {

class StiffClusters {
 public:
  /// Of a cluster. The sewn dress needs a tenth more iterations with 6, and a twentieth less with 16, which take
  /// longer.
  static constexpr int k_most_vertices = 8;
  static constexpr std::size_t k_block = 48;  ///< clusters per block of a loop over them

  /// An off-diagonal block of the pattern that contacts have added to: row < column, place in the matrix.
  struct Coupling {
    int row, column, place;
  };

  /// Of a matrix whose held rows are zero. couplings: also several times; what is extra counts as well.
  void build(const BlockMatrix& matrix, const ExtraRows& extra, std::span<const char> held,
             std::span<const Coupling> couplings);
  void clear();

  int count() const { return clusters_.row_count(); }
  /// Two to k_most_vertices, ascending.
  std::span<const int> members(int cluster) const { return clusters_.row(cluster); }
  /// Whether a vertex is in any.
  bool has(std::size_t vertex) const { return !clustered_.empty() && clustered_[vertex] != 0; }
  /// out = the inverse of the cluster's block times r: displacements [m] of forces [N], both one per member.
  void solve(int cluster, std::span<const Vec4f> r, std::span<Vec4f> out) const;

 private:
  struct Tie {
    float strength;
    int row, column;
  };
  static std::vector<Tie> find_ties(const BlockMatrix& matrix, const ExtraRows& extra, std::span<const char> held,
                                    std::span<const Coupling> couplings);
  void join(std::vector<Tie>& ties, std::size_t vertices);
  void invert(int cluster, const BlockMatrix& matrix, const ExtraRows& extra);

  Adjacency clusters_{{0}, {}};
  std::vector<std::size_t> inverse_start_;
  std::vector<float> inverse_;   ///< per cluster a square matrix, column by column
  std::vector<char> clustered_;  ///< per vertex; empty without any cluster
};

}  // namespace ft::inline solvers

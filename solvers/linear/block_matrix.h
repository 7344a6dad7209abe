// Symmetric sparse matrix of 3x3 float blocks over the vertices of a system: the Hessian of one potential. The pattern
// (which vertex pairs share an element) is built once from the rest shape; values are refilled for every Newton step.
// Contact between vertices that share no element goes into PairTerms, outside the pattern.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft::inline solvers {

/// Who couples to whom. The matrix has the blocks on and above the diagonal alone, row by row; a place is an index into
/// them. What a row has below the diagonal are transposed blocks of earlier rows.
struct BlockPattern {
  struct Mirrored {
    int row, place;
  };
  std::vector<int> diagonal{0};     ///< place of the diagonal block of each row, its first; and the end of the last row
  std::vector<int> column;          ///< of each block of the matrix, ascending within a row
  std::vector<int> below_start{0};  ///< vertex_count + 1
  std::vector<Mirrored> below;      ///< of row i: where blocks (row, i) are, row < i, ascending

  int vertex_count() const { return static_cast<int>(diagonal.size()) - 1; }
  std::size_t block_count() const { return column.size(); }
  /// Place of block (row, column), column >= row, in the matrix, or -1.
  int find(int row, int column) const;
  /// visit(column, place) for all of a row, ascending: place is that of (row, column), below the diagonal of (column,
  /// row).
  template <class Visit>
  void visit_row(int row, Visit&& visit) const;
};

template <class Visit>
void BlockPattern::visit_row(int row, Visit&& visit) const {
  for (int k = below_start[at(row)]; k < below_start[at(row) + 1]; ++k) visit(below[at(k)].row, below[at(k)].place);
  for (int k = diagonal[at(row)]; k < diagonal[at(row) + 1]; ++k) visit(column[at(k)], k);
}

/// Pattern that couples all vertices of every stencil (triangles: 3 vertices; hinges: 4; springs: 2; -1 entries are
/// skipped).
BlockPattern make_pattern(int vertex_count, std::span<const std::vector<std::array<int, 4>>> stencil_lists);
/// The same from what is on and above the diagonal: BlockPattern::diagonal and column.
BlockPattern make_pattern(std::vector<int> diagonal, std::vector<int> column);

struct BlockMatrix {
  const BlockPattern* pattern = nullptr;
  /// block_count(), and one more: who loads columns of three as four reads past the last.
  std::vector<Mat3f> blocks;
  /// For the blocks of a pattern; what is in them is not defined.
  void make_room(const BlockPattern& p);
  /// All zero.
  void reset(const BlockPattern& p);
};

/// K spread over up to four vertices: block (a, b) of the Hessian is weight[a] * weight[b] * stiffness. A contact with
/// normal n and stiffness k has stiffness = k n n^T; friction k_t (I - n n^T); a pin I*k with one vertex. vertex = -1
/// marks an unused or kinematic slot.
struct PairTerm {
  std::array<int, 4> vertex{-1, -1, -1, -1};
  std::array<float, 4> weight{0, 0, 0, 0};
  Mat3f stiffness = Mat3f::Zero();  ///< N/m, positive semidefinite
};

}  // namespace ft::inline solvers

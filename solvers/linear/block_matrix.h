// Symmetric sparse matrix of 3x3 float blocks over the vertices of a system: the Hessian of one potential. The pattern
// (which vertex pairs share an element) is built once from the rest shape; values are refilled for every Newton step.
// Contact between vertices that share no element goes into PairTerms, outside the pattern.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft {

/// Who couples to whom: whole rows, each ascending, the vertex itself included. The matrix has the blocks on and above
/// the diagonal alone, row by row.
struct BlockPattern {
  std::vector<int> row_start;  ///< vertex_count + 1
  std::vector<int> column;
  std::vector<int> place;     ///< in the matrix, as column: of block (row, column), below the diagonal of (column, row)
  std::vector<int> diagonal;  ///< in the matrix: of the diagonal block of each row, the first that it has there
  int vertex_count() const { return static_cast<int>(diagonal.size()); }
  std::size_t block_count() const { return (column.size() + diagonal.size()) / 2; }
  /// Place of block (row, column), column >= row, in the matrix, or -1.
  int find(int row, int column) const;
};

/// Pattern that couples all vertices of every stencil (triangles: 3 vertices; hinges: 4; springs: 2; -1 entries are
/// skipped).
BlockPattern make_pattern(int vertex_count, std::span<const std::vector<std::array<int, 4>>> stencil_lists);

struct BlockMatrix {
  const BlockPattern* pattern = nullptr;
  std::vector<Mat3f> blocks;  ///< block_count(), and one more: who loads columns of three as four reads past the last
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

}  // namespace ft

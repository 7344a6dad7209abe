// Symmetric sparse matrix of 3x3 float blocks over the vertices of a system: the Hessian of one potential. The pattern
// (which vertex pairs share an element) is built once from the rest shape; values are refilled for every Newton step.
// Contact between vertices that share no element goes into PairTerms, outside the pattern.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft {

using Vec4f = Eigen::Vector4f;  ///< a 3-vector padded for aligned loads; the fourth entry is always zero or ignored

/// Compressed block rows, full (both triangles stored), each row ascending, diagonal included.
struct BlockPattern {
  std::vector<int> row_start;  ///< vertex_count + 1
  std::vector<int> column;
  std::vector<int> diagonal;  ///< position of the diagonal block of each row
  int vertex_count() const { return static_cast<int>(diagonal.size()); }
  /// Position of block (row, column), or -1.
  int find(int row, int column) const;
};

/// Pattern that couples all vertices of every stencil (triangles: 3 vertices; hinges: 4; springs: 2; -1 entries are
/// skipped).
BlockPattern make_pattern(int vertex_count, std::span<const std::vector<std::array<int, 4>>> stencil_lists);

struct BlockMatrix {
  const BlockPattern* pattern = nullptr;
  std::vector<Mat3f> blocks;  ///< as pattern->column, and one more: row_product() reads past the last
  /// All zero.
  void reset(const BlockPattern& p);
  /// Row times x (one per vertex).
  Vec4f row_product(std::size_t row, const Vec4f* x) const;
};

/// K spread over up to four vertices: block (a, b) of the Hessian is weight[a] * weight[b] * stiffness. A contact with
/// normal n and stiffness k has stiffness = k n n^T; friction k_t (I - n n^T); a pin I*k with one vertex. vertex = -1
/// marks an unused or kinematic slot.
struct PairTerm {
  std::array<int, 4> vertex{-1, -1, -1, -1};
  std::array<float, 4> weight{0, 0, 0, 0};
  Mat3f stiffness = Mat3f::Zero();  ///< N/m, positive semidefinite
};

/// Two blocks at a time, columns of three loaded as four: the fourth lane collects what nobody looks at.
inline Vec4f BlockMatrix::row_product(std::size_t row, const Vec4f* x) const {
  using Four = float __attribute__((vector_size(16), may_alias));
  using Unaligned = float __attribute__((vector_size(16), may_alias, aligned(4)));
  using Eight = float __attribute__((vector_size(32)));
  static_assert(sizeof(Mat3f) == 9 * sizeof(float));
  const auto load = [](const float* p) { return static_cast<Four>(*reinterpret_cast<const Unaligned*>(p)); };
  const auto join = [](const Four& a, const Four& b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7); };
  const int* column = pattern->column.data() + pattern->row_start[row];
  const int* const end = pattern->column.data() + pattern->row_start[row + 1];
  const float* block = blocks[at(pattern->row_start[row])].data();
  Eight sum{};
  for (; column + 1 < end; column += 2, block += 18) {
    const Four& a = *reinterpret_cast<const Four*>(x + column[0]);
    const Four& b = *reinterpret_cast<const Four*>(x + column[1]);
    const Eight both = join(a, b);
    sum += join(load(block), load(block + 9)) * __builtin_shufflevector(both, both, 0, 0, 0, 0, 4, 4, 4, 4) +
           join(load(block + 3), load(block + 12)) * __builtin_shufflevector(both, both, 1, 1, 1, 1, 5, 5, 5, 5) +
           join(load(block + 6), load(block + 15)) * __builtin_shufflevector(both, both, 2, 2, 2, 2, 6, 6, 6, 6);
  }
  Four whole = __builtin_shufflevector(sum, sum, 0, 1, 2, 3);
  if (column < end) {
    const Four& a = *reinterpret_cast<const Four*>(x + column[0]);
    whole += load(block) * a[0] + load(block + 3) * a[1] + load(block + 6) * a[2];
  }
  whole += __builtin_shufflevector(sum, sum, 4, 5, 6, 7);
  return Vec4f(whole[0], whole[1], whole[2], 0);
}

}  // namespace ft

// Symmetric sparse matrix of 3x3 float blocks as products want it: two blocks of a row lie side by side, column beside
// column, so that one instruction takes both. Rows with an odd number of blocks end with a zero one.
#pragma once

#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"

namespace ft {

using Vec4f = Eigen::Vector4f;  ///< a 3-vector padded for aligned loads; the fourth entry is always zero or ignored

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

class LevelMatrix {
 public:
  /// Zero, with the places of pattern.
  void build(const BlockPattern& pattern);

  /// Where the k-th block of the pattern is, which must be in this row.
  int place(const BlockPattern& pattern, int row, int k) const {
    return 2 * first_pair_[at(row)] + k - pattern.row_start[at(row)];
  }
  /// Column c of the block at a place; the fourth entry is zero and has to stay so.
  Eigen::Map<Vec4f> column(int place, int c) {
    return Eigen::Map<Vec4f>(&pairs_[at(place / 2)].columns[c][4 * (place % 2)]);
  }
  Eigen::Map<const Vec4f> column(int place, int c) const {
    return Eigen::Map<const Vec4f>(&pairs_[at(place / 2)].columns[c][4 * (place % 2)]);
  }
  void set(int place, const Mat3f& block) {
    for (int c = 0; c < 3; ++c) column(place, c).head<3>() = block.col(c);
  }
  Mat3f get(int place) const {
    Mat3f block;
    for (int c = 0; c < 3; ++c) block.col(c) = column(place, c).head<3>();
    return block;
  }

  /// Row times x (one per column of the matrix).
  Vec4f row_product(std::size_t row, const Vec4f* x) const;

 private:
  struct alignas(32) Pair {
    float columns[3][8];
  };
  std::vector<int> first_pair_;  ///< per row, and the end
  std::vector<int> column_;      ///< per place
  std::vector<Pair> pairs_;
};

inline Vec4f LevelMatrix::row_product(std::size_t row, const Vec4f* x) const {
  using Four = float __attribute__((vector_size(16), may_alias));
  using Eight = float __attribute__((vector_size(32), may_alias));
  const Pair* pair = pairs_.data() + first_pair_[row];
  const Pair* const end = pairs_.data() + first_pair_[row + 1];
  const int* column = column_.data() + 2 * first_pair_[row];
  Eight sum{};
  for (; pair != end; ++pair, column += 2) {
    const Four& a = *reinterpret_cast<const Four*>(x + column[0]);
    const Four& b = *reinterpret_cast<const Four*>(x + column[1]);
    const Eight both = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    const Eight* columns = reinterpret_cast<const Eight*>(pair->columns);
    sum += columns[0] * __builtin_shufflevector(both, both, 0, 0, 0, 0, 4, 4, 4, 4) +
           columns[1] * __builtin_shufflevector(both, both, 1, 1, 1, 1, 5, 5, 5, 5) +
           columns[2] * __builtin_shufflevector(both, both, 2, 2, 2, 2, 6, 6, 6, 6);
  }
  const Four whole = __builtin_shufflevector(sum, sum, 0, 1, 2, 3) + __builtin_shufflevector(sum, sum, 4, 5, 6, 7);
  return Vec4f(whole[0], whole[1], whole[2], 0);
}

}  // namespace ft

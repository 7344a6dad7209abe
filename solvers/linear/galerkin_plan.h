// How the next coarser (Galerkin) matrix P^T A P is summed up from the blocks of a matrix: for each coarse block a list
// of blocks and weights, without a search, in a fixed order. There are forty of them per vertex: four bytes each.
#pragma once

#include <cstdint>
#include <vector>

#include "solvers/linear/block_matrix.h"
#include "solvers/linear/interpolation.h"

namespace ft {

class GalerkinPlan {
 public:
  static constexpr int k_offset_bits = 20;

  /// Gives the pattern of the coarse matrix. most_offset: how far from the place that a row counts from an entry's
  /// place is at most, without another entry that moves it; below 2^k_offset_bits.
  BlockPattern build(const BlockPattern& fine, const Interpolation& p,
                     std::uint32_t most_offset = (1u << k_offset_bits) - 1);
  /// coarse = P^T fine P.
  void apply(const BlockMatrix& fine, BlockMatrix& coarse) const;
  std::size_t entry_count() const { return entries_.size(); }

 private:
  /// Weight in units of a share squared, and above it the place in the fine matrix beyond where the list is. With a
  /// weight of zero, that moves where the list is.
  using Entry = std::uint32_t;
  static constexpr int k_weight_bits = 32 - k_offset_bits;
  static_assert(Interpolation::k_shares * Interpolation::k_shares < (1 << k_weight_bits));

  Mat3f sum_of(std::size_t list, const Mat3f* first) const;

  std::vector<int> first_place_;  ///< per coarse row: where its lists begin to count, in the fine matrix
  /// Two lists per coarse block, and their end: of the blocks that come as they are, and transposed. Of a diagonal
  /// block: of those that come both ways, and once.
  std::vector<int> start_;
  std::vector<Entry> entries_;
};

}  // namespace ft

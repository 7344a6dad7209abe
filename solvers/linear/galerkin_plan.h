// How the next coarser (Galerkin) matrix P^T A P is summed up from the blocks of a matrix: for each coarse block a list
// of blocks and weights, without a search, in a fixed order. There are over thirty of them per vertex, so that each is
// two bytes: which of the few products of two shares its weight is, and how far on the next one of the list is.
#pragma once

#include <cstdint>
#include <vector>

#include "solvers/linear/block_matrix.h"
#include "solvers/linear/interpolation.h"

namespace ft::inline solvers {

class GalerkinPlan {
 public:
  /// Gives the pattern of the coarse matrix.
  BlockPattern build(const BlockPattern& fine, const Interpolation& p);
  /// coarse = P^T fine P.
  void apply(const BlockMatrix& fine, BlockMatrix& coarse) const;

 private:
  /// Two lists per coarse block, row by row: of the blocks that come as they are, and transposed. Of a diagonal block:
  /// of those that come both ways, and once. A list is
  ///   zero where there is nothing in it, or the distance of its first block from first_place_, and one more
  ///   for each block: its weight's number, and from bit k_step_bit on how many places on the next one is: k_last after
  ///   the last, k_far and the distance behind it where that is larger.
  /// Distances are as many words of k_most as are full, and the rest.
  using Word = std::uint16_t;
  static constexpr int k_step_bit = 11;
  static constexpr std::uint32_t k_last = 0, k_far = 31, k_most = 0xFFFF;

  void put_distance(std::uint32_t distance);
  static std::uint32_t take_distance(const Word*& next);
  static Mat3f take_sum(const Word*& next, const Mat3f* first);

  std::vector<int> first_place_;    ///< per coarse row: the lowest place of its lists, in the fine matrix
  std::vector<std::size_t> start_;  ///< per block of coarse rows
  std::vector<Word> words_;
};

}  // namespace ft::inline solvers

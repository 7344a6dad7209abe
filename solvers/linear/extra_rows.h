// The blocks of a matrix that its pattern has no place for: what contacts couple. Gathered by rows, so that products
// run through parallel loops.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"

namespace ft::inline solvers {

/// A block above the diagonal, and the one that mirrors it: of two vertices of a term, by their place in it. Its value
/// is the same for both.
struct ExtraBlock {
  int row, column;
  int term;
  std::uint8_t of_row, of_column;
};

/// Both halves of a symmetric matrix. Columns ascend within a row, and each place has one block.
struct ExtraRows {
  std::vector<int> start;  ///< per row, and the end of the last; empty without any blocks
  std::vector<int> used;   ///< per row: blocks from start on
  std::vector<int> column;
  std::vector<Mat3f> value;

  bool empty() const { return start.empty(); }
  void clear();
  /// Adds blocks to those there are, of the same number of rows. Blocks of one place are added up in the order in which
  /// they come.
  void add(std::span<const ExtraBlock> blocks, std::span<const PairTerm> terms, std::size_t rows);

 private:
  void gather(std::span<const ExtraBlock> blocks, std::span<const PairTerm> terms, std::size_t rows);
  void merge(const ExtraRows& more);

  std::vector<int> order_;
};

}  // namespace ft::inline solvers

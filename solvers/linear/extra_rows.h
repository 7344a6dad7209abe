// The blocks of a matrix that its pattern has no place for: what contacts couple. Gathered by rows, so that products
// run through parallel loops.
#pragma once

#include <span>
#include <vector>

#include "solvers/linear/block_matrix.h"

namespace ft {

struct ExtraBlock {
  int row, column;
  Mat3f value;
};

/// Columns ascend within a row, and each place has one block.
struct ExtraRows {
  std::vector<int> start;  ///< per row, and the end of the last
  std::vector<int> used;   ///< per row: blocks from start on
  std::vector<int> column;
  std::vector<Mat3f> value;

  /// Blocks of one place are added up in the order in which they come.
  void gather(std::span<const ExtraBlock> blocks, std::size_t rows);

 private:
  std::vector<int> order_;
};

}  // namespace ft

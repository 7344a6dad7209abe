#include "solvers/linear/block_matrix.h"

#include <algorithm>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 8192;  ///< blocks of the matrix per block of a loop

}  // namespace

int BlockPattern::find(int row, int col) const {
  const auto begin = column.begin() + row_start[static_cast<std::size_t>(row)];
  const auto end = column.begin() + row_start[static_cast<std::size_t>(row) + 1];
  const auto it = std::lower_bound(begin, end, col);
  return it != end && *it == col ? place[static_cast<std::size_t>(it - column.begin())] : -1;
}

void BlockMatrix::reset(const BlockPattern& p) {
  pattern = &p;
  blocks.resize(p.block_count() + 1);
  parallel_for(blocks.size(), k_block,
               [&](std::size_t begin, std::size_t end) { std::fill_n(&blocks[begin], end - begin, Mat3f::Zero()); });
}

BlockPattern make_pattern(int vertex_count, std::span<const std::vector<std::array<int, 4>>> stencil_lists) {
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(vertex_count));
  for (int v = 0; v < vertex_count; ++v) rows[static_cast<std::size_t>(v)].push_back(v);
  for (const auto& list : stencil_lists)
    for (const auto& stencil : list)
      for (const int a : stencil)
        for (const int b : stencil) {
          if (a < 0 || b < 0 || a == b) continue;
          CHECK(a < vertex_count && b < vertex_count);
          rows[static_cast<std::size_t>(a)].push_back(b);
        }
  BlockPattern pattern;
  pattern.row_start.push_back(0);
  std::vector<int> next;  // above the diagonal of each row so far: the next place, since rows come in ascending order
  int count = 0;
  for (int v = 0; v < vertex_count; ++v) {
    auto& row = rows[static_cast<std::size_t>(v)];
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern.diagonal.push_back(count);
    next.push_back(count + 1);
    for (const int u : row) {
      pattern.column.push_back(u);
      pattern.place.push_back(u < v ? next[at(u)]++ : count++);
    }
    pattern.row_start.push_back(static_cast<int>(pattern.column.size()));
  }
  return pattern;
}

}  // namespace ft

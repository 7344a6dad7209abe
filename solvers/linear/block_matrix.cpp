#include "solvers/linear/block_matrix.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 8192;  ///< blocks of the matrix per block of a loop

}  // namespace

int BlockPattern::find(int row, int col) const {
  const auto begin = column.begin() + diagonal[at(row)], end = column.begin() + diagonal[at(row) + 1];
  const auto it = std::lower_bound(begin, end, col);
  return it != end && *it == col ? static_cast<int>(it - column.begin()) : -1;
}

void BlockMatrix::make_room(const BlockPattern& p) {
  pattern = &p;
  blocks.resize(p.block_count() + 1);
}

void BlockMatrix::reset(const BlockPattern& p) {
  make_room(p);
  parallel_for(blocks.size(), k_block,
               [&](std::size_t begin, std::size_t end) { std::fill_n(&blocks[begin], end - begin, Mat3f::Zero()); });
}

BlockPattern make_pattern(int vertex_count, std::span<const std::vector<std::array<int, 4>>> stencil_lists) {
  const auto each_pair = [&](auto&& take) {
    for (const auto& list : stencil_lists)
      for (const auto& stencil : list)
        for (const int a : stencil)
          for (const int b : stencil)
            if (a >= 0 && a < b) take(a, b);
  };
  // Higher vertices beside each, as often as they share a stencil; then once each, in the same place.
  std::vector<int> start(at(vertex_count) + 1, 0), end, higher;
  each_pair([&](int a, int b) {
    CHECK(b < vertex_count);
    ++start[at(a) + 1];
  });
  std::partial_sum(start.begin(), start.end(), start.begin());
  higher.resize(at(start.back()));
  end.assign(start.begin(), start.end() - 1);
  each_pair([&](int a, int b) { higher[at(end[at(a)]++)] = b; });
  std::vector<int> diagonal, column;
  diagonal.reserve(at(vertex_count) + 1);
  diagonal.push_back(0);
  for (int v = 0; v < vertex_count; ++v) {
    const auto first = higher.begin() + start[at(v)], last = higher.begin() + end[at(v)];
    std::sort(first, last);
    end[at(v)] = static_cast<int>(std::unique(first, last) - higher.begin());
    diagonal.push_back(diagonal.back() + 1 + end[at(v)] - start[at(v)]);
  }
  column.reserve(at(diagonal.back()));
  for (int v = 0; v < vertex_count; ++v) {
    column.push_back(v);
    column.insert(column.end(), higher.begin() + start[at(v)], higher.begin() + end[at(v)]);
  }
  return make_pattern(std::move(diagonal), std::move(column));
}

BlockPattern make_pattern(std::vector<int> diagonal, std::vector<int> column) {
  BlockPattern pattern;
  pattern.diagonal = std::move(diagonal);
  pattern.column = std::move(column);
  const int n = pattern.vertex_count();
  pattern.below_start.assign(at(n) + 1, 0);
  pattern.below.resize(pattern.block_count() - at(n));
  const auto each_above = [&](auto&& take) {
    for (int i = 0; i < n; ++i)
      for (int k = pattern.diagonal[at(i)] + 1; k < pattern.diagonal[at(i) + 1]; ++k) take(i, k);
  };
  each_above([&](int, int k) { ++pattern.below_start[at(pattern.column[at(k)]) + 1]; });
  std::partial_sum(pattern.below_start.begin(), pattern.below_start.end(), pattern.below_start.begin());
  std::vector<int> next = pattern.below_start;
  each_above([&](int i, int k) { pattern.below[at(next[at(pattern.column[at(k)])]++)] = {i, k}; });
  return pattern;
}

}  // namespace ft::inline solvers

#include "solvers/linear/extra_rows.h"

#include <algorithm>
#include <utility>

#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_rows = 1024;  ///< per block of a loop

}  // namespace

void ExtraRows::gather(std::span<const ExtraBlock> blocks, std::size_t rows) {
  start.assign(rows + 1, 0);
  used.assign(rows, 0);
  for (const ExtraBlock& b : blocks) ++start[at(b.row) + 1];
  for (std::size_t i = 0; i < rows; ++i) start[i + 1] += start[i];
  order_.resize(blocks.size());
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const std::size_t row = at(blocks[k].row);
    order_[at(start[row] + used[row]++)] = static_cast<int>(k);
  }
  column.resize(blocks.size());
  value.resize(blocks.size());
  parallel_for(rows, k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      int* const first = order_.data() + start[i];
      int* const last = first + used[i];
      std::sort(first, last,
                [&](int a, int b) { return std::pair(blocks[at(a)].column, a) < std::pair(blocks[at(b)].column, b); });
      int next = start[i] - 1;
      for (const int* k = first; k != last; ++k) {
        const ExtraBlock& b = blocks[at(*k)];
        if (next >= start[i] && column[at(next)] == b.column) {
          value[at(next)] += b.value;
        } else {
          ++next;
          column[at(next)] = b.column;
          value[at(next)] = b.value;
        }
      }
      used[i] = next + 1 - start[i];
    }
  });
}

}  // namespace ft

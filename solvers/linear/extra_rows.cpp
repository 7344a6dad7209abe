#include "solvers/linear/extra_rows.h"

#include <algorithm>
#include <utility>

#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_rows = 1024;  ///< per block of a loop

Mat3f value_of(const ExtraBlock& b, std::span<const PairTerm> terms) {
  const PairTerm& term = terms[at(b.term)];
  return (term.weight[b.of_row] * term.weight[b.of_column]) * term.stiffness;
}

}  // namespace

void ExtraRows::clear() {
  for (auto* list : {&start, &used, &column}) list->clear();
  value.clear();
}

void ExtraRows::add(std::span<const ExtraBlock> blocks, std::span<const PairTerm> terms, std::size_t rows) {
  if (blocks.empty()) return;
  if (empty()) return gather(blocks, terms, rows);
  ExtraRows more;
  more.gather(blocks, terms, rows);
  merge(more);
}

/// Row by row, both ascending.
void ExtraRows::merge(const ExtraRows& more) {
  ExtraRows sum;
  sum.start.assign(start.size(), 0);
  sum.used.assign(used.size(), 0);
  for (std::size_t i = 0; i < used.size(); ++i) {
    sum.start[i] = static_cast<int>(sum.column.size());
    int a = start[i], b = more.start[i];
    const int a_end = a + used[i], b_end = b + more.used[i];
    while (a < a_end || b < b_end) {
      const bool of_this = b == b_end || (a < a_end && column[at(a)] <= more.column[at(b)]);
      const bool of_both = of_this && b < b_end && column[at(a)] == more.column[at(b)];
      sum.column.push_back(of_this ? column[at(a)] : more.column[at(b)]);
      sum.value.push_back(of_this ? value[at(a)] : more.value[at(b)]);
      if (of_both) sum.value.back() += more.value[at(b)];
      if (of_this) ++a;
      if (of_both || !of_this) ++b;
    }
    sum.used[i] = static_cast<int>(sum.column.size()) - sum.start[i];
  }
  sum.start.back() = static_cast<int>(sum.column.size());
  *this = std::move(sum);
}

void ExtraRows::gather(std::span<const ExtraBlock> blocks, std::span<const PairTerm> terms, std::size_t rows) {
  start.assign(rows + 1, 0);
  used.assign(rows, 0);
  for (const ExtraBlock& b : blocks) ++start[at(b.row) + 1], ++start[at(b.column) + 1];
  for (std::size_t i = 0; i < rows; ++i) start[i + 1] += start[i];
  order_.resize(2 * blocks.size());
  for (std::size_t k = 0; k < blocks.size(); ++k)
    for (const int row : {blocks[k].row, blocks[k].column})
      order_[at(start[at(row)] + used[at(row)]++)] = static_cast<int>(k);
  column.resize(order_.size());
  value.resize(order_.size());
  parallel_for(rows, k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto column_of = [&](int k) { return blocks[at(k)].row + blocks[at(k)].column - static_cast<int>(i); };
      int* const first = order_.data() + start[i];
      int* const last = first + used[i];
      std::sort(first, last, [&](int a, int b) { return std::pair(column_of(a), a) < std::pair(column_of(b), b); });
      int next = start[i] - 1;
      for (const int* k = first; k != last; ++k) {
        if (next >= start[i] && column[at(next)] == column_of(*k)) {
          value[at(next)] += value_of(blocks[at(*k)], terms);
        } else {
          ++next;
          column[at(next)] = column_of(*k);
          value[at(next)] = value_of(blocks[at(*k)], terms);
        }
      }
      used[i] = next + 1 - start[i];
    }
  });
}

}  // namespace ft::inline solvers

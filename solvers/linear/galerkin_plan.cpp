#include "solvers/linear/galerkin_plan.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "solvers/linear/row_product.h"

namespace ft {
namespace {

constexpr std::size_t k_rows = 64;  ///< coarse rows per block of a loop

/// One fine block in one coarse block of a row.
struct Contribution {
  int column;  ///< of the coarse block
  int list;    ///< 0 or 1
  int place;
  int weight;
};

/// All of one coarse row on and above the diagonal, by block, list and place.
void contributions_of(std::size_t row, const BlockPattern& fine, const Interpolation& p,
                      std::vector<Contribution>& out) {
  out.clear();
  const int own = static_cast<int>(row);
  for (int c = p.children_start[row]; c < p.children_start[row + 1]; ++c) {
    const int i = p.children[at(c)];
    fine.visit_row(i, [&](int j, int place) {
      const Interpolation::Row& support = p.rows[at(j)];
      for (std::size_t b = 0; b < 3; ++b) {
        const int column = support.coarse[b];
        if (column < own || (column == own && j < i)) continue;
        const bool second = column == own ? j == i : j < i;
        out.push_back({column, second ? 1 : 0, place, p.children_share[at(c)] * support.share[b]});
      }
    });
  }
  std::sort(out.begin(), out.end(), [](const Contribution& a, const Contribution& b) {
    return std::tie(a.column, a.list, a.place) < std::tie(b.column, b.list, b.place);
  });
}

}  // namespace

BlockPattern GalerkinPlan::build(const BlockPattern& fine, const Interpolation& p, std::uint32_t most_offset) {
  const std::size_t rows = at(p.coarse_count());
  first_place_.clear();
  start_.assign(1, 0);
  entries_.clear();
  std::vector<int> diagonal{0}, column;
  std::vector<Contribution> all;
  for (std::size_t row = 0; row < rows; ++row) {
    contributions_of(row, fine, p, all);
    CHECK(!all.empty());
    int first = std::numeric_limits<int>::max();
    for (const Contribution& c : all) first = std::min(first, c.place);
    first_place_.push_back(first);
    for (auto next = all.begin(); next != all.end();) {
      column.push_back(next->column);
      for (const int list : {0, 1}) {
        std::uint32_t from = static_cast<std::uint32_t>(first);
        for (; next != all.end() && next->column == column.back() && next->list == list; ++next) {
          const auto place = static_cast<std::uint32_t>(next->place);
          for (; place - from > most_offset; from += most_offset) entries_.push_back(most_offset << k_weight_bits);
          entries_.push_back((place - from) << k_weight_bits | static_cast<std::uint32_t>(next->weight));
        }
        start_.push_back(static_cast<int>(entries_.size()));
      }
    }
    diagonal.push_back(static_cast<int>(column.size()));
  }
  entries_.shrink_to_fit();
  start_.shrink_to_fit();
  column.shrink_to_fit();
  return make_pattern(std::move(diagonal), std::move(column));
}

Mat3f GalerkinPlan::sum_of(std::size_t list, const Mat3f* first) const {
  using namespace detail;
  Eight eight{};
  float ninth = 0;
  for (int k = start_[list]; k < start_[list + 1]; ++k) {
    const Entry entry = entries_[at(k)];
    const int shares = static_cast<int>(entry & ((1u << k_weight_bits) - 1));
    const Mat3f* const place = first + (entry >> k_weight_bits);
    if (shares == 0) {
      first = place;
      continue;
    }
    const float* const block = place->data();
    const float weight = static_cast<float>(shares);
    const Eight weights{weight, weight, weight, weight, weight, weight, weight, weight};
    eight = multiply_add(load_eight(block), weights, eight);
    ninth += weight * block[8];
  }
  Mat3f sum;
  std::copy_n(reinterpret_cast<const float*>(&eight), 8, sum.data());
  sum(2, 2) = ninth;
  return (Interpolation::k_share * Interpolation::k_share) * sum;
}

void GalerkinPlan::apply(const BlockMatrix& fine, BlockMatrix& coarse) const {
  const BlockPattern& p = *coarse.pattern;
  parallel_for(at(p.vertex_count()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const Mat3f* const first = fine.blocks.data() + first_place_[row];
      const std::size_t diagonal = at(p.diagonal[row]);
      const Mat3f both = sum_of(2 * diagonal, first), once = sum_of(2 * diagonal + 1, first);
      coarse.blocks[diagonal] = both + both.transpose() + 0.5f * (once + once.transpose());
      for (std::size_t e = diagonal + 1; e < at(p.diagonal[row + 1]); ++e)
        coarse.blocks[e] = sum_of(2 * e, first) + sum_of(2 * e + 1, first).transpose();
    }
  });
}

}  // namespace ft

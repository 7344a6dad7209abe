#include "solvers/linear/galerkin_plan.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "solvers/linear/row_product.h"

namespace ft::inline solvers {
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
    const Interpolation::Link child = p.children[at(c)];
    const int i = static_cast<int>(child.vertex);
    fine.visit_row(i, [&](int j, int place) {
      for (const Interpolation::Link support : p.rows[at(j)]) {
        const int column = static_cast<int>(support.vertex);
        if (support.share == 0 || column < own || (column == own && j < i)) continue;
        const bool second = column == own ? j == i : j < i;
        out.push_back({column, second ? 1 : 0, place, static_cast<int>(child.share * support.share)});
      }
    });
  }
  std::sort(out.begin(), out.end(), [](const Contribution& a, const Contribution& b) {
    return std::tie(a.column, a.list, a.place) < std::tie(b.column, b.list, b.place);
  });
}

/// Products of two shares, ascending, and behind them more than any.
constexpr auto k_weights = [] {
  constexpr int most = Interpolation::k_shares * Interpolation::k_shares;
  std::array<bool, most + 1> is_product{};
  for (int a = 1; a <= Interpolation::k_shares; ++a)
    for (int b = 1; b <= Interpolation::k_shares; ++b) is_product[a * b] = true;
  std::array<float, 2048> weights{};
  std::size_t count = 0;
  for (int w = 0; w <= most; ++w)
    if (is_product[w]) weights[count++] = static_cast<float>(w);
  for (; count < weights.size(); ++count) weights[count] = most + 1;
  return weights;
}();

std::uint32_t number_of(int weight) {
  const auto place = std::lower_bound(k_weights.begin(), k_weights.end(), static_cast<float>(weight));
  return static_cast<std::uint32_t>(place - k_weights.begin());
}

}  // namespace

void GalerkinPlan::put_distance(std::uint32_t distance) {
  for (; distance >= k_most; distance -= k_most) words_.push_back(k_most);
  words_.push_back(static_cast<Word>(distance));
}

inline std::uint32_t GalerkinPlan::take_distance(const Word*& next) {
  std::uint32_t distance = 0;
  while (*next == k_most) distance += *next++;
  return distance + *next++;
}

BlockPattern GalerkinPlan::build(const BlockPattern& fine, const Interpolation& p) {
  const std::size_t rows = at(p.coarse_count());
  first_place_.assign(rows, std::numeric_limits<int>::max());
  start_.clear();
  words_.clear();
  std::vector<int> diagonal, column;
  diagonal.reserve(rows + 1);
  diagonal.push_back(0);
  std::vector<Contribution> all;
  for (std::size_t row = 0; row < rows; ++row) {
    contributions_of(row, fine, p, all);
    CHECK(!all.empty());
    if (row % k_rows == 0) start_.push_back(words_.size());
    for (const Contribution& c : all) first_place_[row] = std::min(first_place_[row], c.place);
    for (auto next = all.begin(); next != all.end();) {
      column.push_back(next->column);
      for (const int list : {0, 1}) {
        const auto end = std::find_if(
            next, all.end(), [&](const Contribution& c) { return c.column != column.back() || c.list != list; });
        put_distance(next == end ? 0 : 1 + static_cast<std::uint32_t>(next->place - first_place_[row]));
        for (; next != end; ++next) {
          const std::uint32_t step = next + 1 == end ? k_last : static_cast<std::uint32_t>(next[1].place - next->place);
          words_.push_back(static_cast<Word>(number_of(next->weight) | std::min(step, k_far) << k_step_bit));
          if (step >= k_far) put_distance(step);
        }
      }
    }
    diagonal.push_back(static_cast<int>(column.size()));
  }
  words_.shrink_to_fit();
  column.shrink_to_fit();
  return make_pattern(std::move(diagonal), std::move(column));
}

inline Mat3f GalerkinPlan::take_sum(const Word*& next, const Mat3f* first) {
  using namespace products;
  Eight eight{};
  float ninth = 0;
  const std::uint32_t distance = take_distance(next);
  const Mat3f* place = distance == 0 ? first : first + distance - 1;
  for (std::uint32_t step = distance == 0 ? k_last : k_far; step != k_last;) {
    const std::uint32_t word = *next++;
    const float* const block = place->data();
    const float weight = k_weights[word & ((1u << k_step_bit) - 1)];
    const Eight weights{weight, weight, weight, weight, weight, weight, weight, weight};
    eight = multiply_add(load_eight(block), weights, eight);
    ninth += weight * block[8];
    step = word >> k_step_bit;
    place += step == k_far ? take_distance(next) : step;
  }
  Mat3f sum;
  std::copy_n(reinterpret_cast<const float*>(&eight), 8, sum.data());
  sum(2, 2) = ninth;
  return (Interpolation::k_share * Interpolation::k_share) * sum;
}

void GalerkinPlan::apply(const BlockMatrix& fine, BlockMatrix& coarse) const {
  const BlockPattern& p = *coarse.pattern;
  parallel_for(at(p.vertex_count()), k_rows, [&](std::size_t begin, std::size_t end) {
    const Word* next = words_.data() + start_[begin / k_rows];
    for (std::size_t row = begin; row < end; ++row) {
      const Mat3f* const first = fine.blocks.data() + first_place_[row];
      const std::size_t diagonal = at(p.diagonal[row]);
      const Mat3f both = take_sum(next, first), once = take_sum(next, first);
      coarse.blocks[diagonal] = both + both.transpose() + 0.5f * (once + once.transpose());
      for (std::size_t e = diagonal + 1; e < at(p.diagonal[row + 1]); ++e) {
        const Mat3f as_is = take_sum(next, first), transposed = take_sum(next, first);
        coarse.blocks[e] = as_is + transposed.transpose();
      }
    }
  });
}

}  // namespace ft::inline solvers

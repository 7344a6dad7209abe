#include "collision/broad_phase/pair_runs.h"

#include <algorithm>

#include "baker/core/give_back.h"

namespace ft::inline collision {
namespace {

/// First of sorted `list` that is not less than what; looks near its beginning first.
std::size_t lower_bound_near(std::span<const PairKey> list, PairKey what) {
  std::size_t from = 0, stride = 1;
  while (from + stride < list.size() && list[from + stride] < what) from += stride, stride *= 2;
  const auto end = list.begin() + static_cast<std::ptrdiff_t>(std::min(from + stride + 1, list.size()));
  return static_cast<std::size_t>(std::lower_bound(list.begin() + static_cast<std::ptrdiff_t>(from), end, what) -
                                  list.begin());
}

/// Marks what of sorted `wanted` is in sorted `list`.
void mark_known(std::span<const PairKey> list, std::span<const PairKey> wanted, std::vector<char>& known) {
  for (std::size_t i = 0; i < wanted.size() && !list.empty(); ++i) {
    list = list.subspan(lower_bound_near(list, wanted[i]));
    if (!list.empty() && list.front() == wanted[i]) known[i] = 1;
  }
}

}  // namespace

void PairRuns::add(std::span<const PairKey> fresh, std::vector<PairKey>& list) {
  if (fresh.empty()) return;
  known_.assign(fresh.size(), 0);
  for (std::size_t r = 0; r < begins_.size(); ++r) {
    const std::size_t end = r + 1 < begins_.size() ? begins_[r + 1] : list.size();
    mark_known(std::span(list).subspan(begins_[r], end - begins_[r]), fresh, known_);
  }
  const std::size_t before = list.size();
  reserve_sparingly(list, before + static_cast<std::size_t>(std::count(known_.begin(), known_.end(), 0)));
  for (std::size_t i = 0; i < fresh.size(); ++i)
    if (known_[i] == 0) list.push_back(fresh[i]);
  if (list.size() > before) begins_.push_back(before);
}

}  // namespace ft::inline collision

// Sorting of keys of feature pairs (pair_list.h) that come up in any order: one counting pass over first features, then
// a short sort within each; three times as fast as std::sort at half a million pairs. Few pairs are sorted as they are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "collision/broad_phase/pair_list.h"

namespace ft::inline collision {

/// All keys of the parts, ascending. First features are below first_count.
inline std::vector<PairKey> sorted_keys(std::span<const std::span<const PairKey>> parts, std::size_t first_count) {
  constexpr std::size_t k_few = 16;  // fewer keys than one for so many first features
  std::size_t count = 0;
  for (const auto& keys : parts) count += keys.size();
  std::vector<PairKey> sorted;
  if (count < first_count / k_few) {
    sorted.reserve(count);
    for (const auto& keys : parts) sorted.insert(sorted.end(), keys.begin(), keys.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }
  CHECK(count <= std::numeric_limits<std::uint32_t>::max());
  std::vector<std::uint32_t> start(first_count + 1, 0);
  for (const auto& keys : parts)
    for (const PairKey key : keys) ++start[at(key_first(key)) + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  sorted.resize(count);
  std::vector<std::uint32_t> place(start.begin(), start.end() - 1);
  for (const auto& keys : parts)
    for (const PairKey key : keys) sorted[place[at(key_first(key))]++] = key;
  parallel_for(first_count, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto first = sorted.begin() + static_cast<std::ptrdiff_t>(start[i]);
      const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(start[i + 1]);
      std::sort(first, last);
    }
  });
  return sorted;
}

}  // namespace ft::inline collision

// A list of keys of pairs that grows at its end: sorted runs, one behind the other, no pair twice. What is added costs
// a look at the list and no copy of it, and whoever keeps something per pair keeps it.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "baker/core/parallel.h"
#include "collision/broad_phase/pair_list.h"

namespace ft::inline collision {

/// Knows where the runs of a list begin, which is given to every call; all calls but begin() are about the same list.
class PairRuns {
 public:
  /// The list is sorted, as one run.
  void begin() { begins_.assign(1, 0); }

  /// Appends as a run what of sorted `fresh` is not in the list.
  void add(std::span<const PairKey> fresh, std::vector<PairKey>& list);

  /// Drops the pairs for which drop(key) is true. It is called from several threads, more than once per pair.
  template <class Drop>
  void erase_if(std::vector<PairKey>& list, Drop&& drop) {
    const std::size_t blocks = block_count(list.size(), k_block);
    place_.assign(blocks + 1, 0);
    const auto kept = [&](std::size_t begin, std::size_t end) {
      std::size_t count = 0;
      for (std::size_t i = begin; i < end; ++i) count += drop(list[i]) ? 0 : 1;
      return count;
    };
    parallel_for(list.size(), k_block,
                 [&](std::size_t begin, std::size_t end) { place_[begin / k_block + 1] = kept(begin, end); });
    for (std::size_t b = 0; b < blocks; ++b) place_[b + 1] += place_[b];
    if (place_[blocks] == list.size()) return;
    for (std::size_t& first : begins_)
      first = place_[first / k_block] + kept(first / k_block * k_block, std::min(first, list.size()));
    // Each block closes its gaps, then the blocks close up.
    parallel_for(list.size(), k_block, [&](std::size_t begin, std::size_t end) {
      std::size_t to = begin;
      for (std::size_t i = begin; i < end; ++i)
        if (!drop(list[i])) list[to++] = list[i];
    });
    for (std::size_t b = 0; b < blocks; ++b)
      std::copy_n(list.begin() + static_cast<std::ptrdiff_t>(b * k_block), place_[b + 1] - place_[b],
                  list.begin() + static_cast<std::ptrdiff_t>(place_[b]));
    list.resize(place_[blocks]);
  }

 private:
  static constexpr std::size_t k_block = 4096;

  std::vector<std::size_t> begins_{0};  ///< of the runs, ascending
  // Scratch.
  std::vector<std::size_t> place_;
  std::vector<char> known_;
};

}  // namespace ft::inline collision

// Where the blocks of every element sit in the matrix, looked up once per pattern, so that assembly never searches.
// For the energies that add element matrices. Caution: a pattern is recognised by its address and size; it must not be
// edited in place.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "baker/core/check.h"
#include "solvers/linear/block_matrix.h"

namespace ft {

/// Blocks (a, b) of each slot at Corners * a + b; slots of element -1 are left at -1.
template <int Corners>
class BlockPositions {
 public:
  using Positions = std::array<int, Corners * Corners>;

  /// Slots hold indices of stencils; corners of -1 are left at -1, too.
  template <class Stencils>
  void bind(const BlockPattern& pattern, const Stencils& stencils, std::span<const int> slots) {
    if (pattern_ == &pattern && columns_ == pattern.column.size()) return;
    positions_.resize(slots.size());
    for (std::size_t s = 0; s < slots.size(); ++s) {
      positions_[s].fill(-1);
      if (slots[s] < 0) continue;
      const auto& v = stencils[static_cast<std::size_t>(slots[s])];
      for (std::size_t a = 0; a < Corners; ++a)
        for (std::size_t b = 0; b < Corners; ++b) {
          if (v[a] < 0 || v[b] < 0) continue;
          const int p = pattern.find(v[a], v[b]);
          CHECK(p >= 0);
          positions_[s][Corners * a + b] = p;
        }
    }
    pattern_ = &pattern;
    columns_ = pattern.column.size();
  }
  const Positions& operator[](std::size_t slot) const { return positions_[slot]; }

 private:
  const BlockPattern* pattern_ = nullptr;
  std::size_t columns_ = 0;
  std::vector<Positions> positions_;
};

}  // namespace ft

// Where the blocks of every element on and above the diagonal sit in the matrix, looked up once per pattern, so that
// assembly never searches.
// For the energies that add element matrices. Caution: a pattern is recognised by its address and size; it must not be
// edited in place.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "baker/core/check.h"
#include "solvers/linear/block_matrix.h"

namespace ft {

/// Corners a and b >= a of each slot at index_of(a, b), in the row of the lower of the two vertices; slots of element
/// -1 are left at -1.
template <int Corners>
class BlockPositions {
 public:
  using Positions = std::array<int, Corners*(Corners + 1) / 2>;
  static constexpr std::size_t index_of(std::size_t a, std::size_t b) { return a * (2 * Corners - 1 - a) / 2 + b; }

  /// Slots hold elements; vertex(slot, corner) is asked for those of one. Corners of -1 are left at -1, too.
  template <class Vertex>
  void bind(const BlockPattern& pattern, std::span<const int> slots, Vertex&& vertex) {
    if (pattern_ == &pattern && columns_ == pattern.column.size()) return;
    positions_.resize(slots.size());
    for (std::size_t s = 0; s < slots.size(); ++s) {
      positions_[s].fill(-1);
      if (slots[s] < 0) continue;
      for (std::size_t a = 0; a < Corners; ++a)
        for (std::size_t b = a; b < Corners; ++b) {
          const auto [row, column] = std::minmax({vertex(s, a), vertex(s, b)});
          if (row < 0) continue;
          const int p = pattern.find(row, column);
          CHECK(p >= 0);
          positions_[s][index_of(a, b)] = p;
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

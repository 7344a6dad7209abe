// Where the blocks of every element above the diagonal sit in the matrix, looked up once per pattern, so that assembly
// does not search: how far each lies behind the diagonal of its row, in a byte. Only in rows of more blocks than a byte
// counts is what lies farther searched for.
// For the energies that add element matrices. Caution: a pattern is recognised by its address and size; it must not be
// edited in place.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "baker/core/check.h"
#include "solvers/energies/block_scatter.h"
#include "solvers/energies/element_schedule.h"
#include "solvers/linear/block_matrix.h"

namespace ft::inline solvers {

/// Slots hold elements, k_lanes of them a group; a block of corners a and b of a slot is in the row of the lower of the
/// two vertices.
template <int Corners>
class BlockPositions {
 public:
  /// Of corners a and b > a.
  static constexpr std::size_t index_of(std::size_t a, std::size_t b) {
    return a * (2 * Corners - 1 - a) / 2 + b - a - 1;
  }

  /// vertex(slot, corner) is below 0 for a corner that is not there.
  template <class Vertex>
  void bind(const BlockPattern& pattern, std::size_t slots, Vertex&& vertex) {
    if (pattern_ == &pattern && columns_ == pattern.column.size()) return;
    groups_.assign(block_count(slots, k_lanes), {});
    any_far_ = false;
    for (std::size_t s = 0; s < slots; ++s)
      for (std::size_t a = 0; a < Corners; ++a)
        for (std::size_t b = a + 1; b < Corners; ++b) {
          const int va = vertex(s, a), vb = vertex(s, b), row = std::min(va, vb);
          if (row < 0) continue;
          const int p = pattern.find(row, std::max(va, vb));
          CHECK(p >= 0);
          const int behind = std::min(p - pattern.diagonal[at(row)], k_far);
          groups_[s / k_lanes].behind[index_of(a, b)][s % k_lanes] = static_cast<std::uint8_t>(behind);
          any_far_ = any_far_ || behind == k_far;
        }
    pattern_ = &pattern;
    columns_ = pattern.column.size();
  }

  /// Of corners a and b of a slot, which are vertices va and vb of the pattern that was bound.
  int place(std::size_t slot, std::size_t a, std::size_t b, int va, int vb) const {
    const int row = std::min(va, vb), diagonal = pattern_->diagonal[at(row)];
    if (a == b) return diagonal;
    const int behind = groups_[slot / k_lanes].behind[index_of(std::min(a, b), std::max(a, b))][slot % k_lanes];
    return behind == k_far ? pattern_->find(row, std::max(va, vb)) : diagonal + behind;
  }

  /// Of the corners a and b > a of a group. diagonal: places of the diagonal blocks of those vertices.
  LaneInts places(std::size_t group, std::size_t a, std::size_t b, const LaneInts* vertex,
                  const LaneInts* diagonal) const {
    LaneBytes bytes;
    std::memcpy(&bytes, groups_[group].behind[index_of(a, b)], sizeof bytes);
    const LaneInts behind = __builtin_convertvector(bytes, LaneInts);
    LaneInts out = (vertex[a] > vertex[b] ? diagonal[b] : diagonal[a]) + behind;
    if (any_far_)
      for (int l = 0; l < k_lanes; ++l)
        if (behind[l] == k_far)
          out[l] = pattern_->find(std::min(vertex[a][l], vertex[b][l]), std::max(vertex[a][l], vertex[b][l]));
    return out;
  }

 private:
  static constexpr int k_far = 255;
  static constexpr std::size_t k_pairs = Corners * (Corners - 1) / 2;
  using LaneBytes = std::uint8_t __attribute__((vector_size(k_lanes)));
  struct Group {
    std::uint8_t behind[k_pairs][k_lanes];  ///< the diagonal; k_far: that or farther
  };
  const BlockPattern* pattern_ = nullptr;
  std::size_t columns_ = 0;
  bool any_far_ = false;
  std::vector<Group> groups_;
};

}  // namespace ft::inline solvers

// Adds k_lanes 3x3 blocks, computed side by side in vector registers, to their places in the matrix: one transposition
// in registers, then nine consecutive floats per block. For the energies; GCC and Clang vector extensions, so it
// compiles for any machine.
#pragma once

#include <cstring>
#include <span>

#include "baker/core/types.h"
#include "solvers/energies/element_schedule.h"

namespace ft::inline solvers {

using Lanes = float __attribute__((vector_size(4 * k_lanes)));   ///< one number of k_lanes elements
using LaneInts = int __attribute__((vector_size(4 * k_lanes)));  ///< or one integer; of a comparison, -1 or 0

namespace lanes {

/// out[l][k] = in[k][l].
inline void transpose(const Lanes* in, Lanes* out) {
  Lanes t[8], s[8];
  for (int i = 0; i < 8; i += 2) {
    t[i] = __builtin_shufflevector(in[i], in[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    t[i + 1] = __builtin_shufflevector(in[i], in[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int i = 0; i < 8; i += 4)
    for (int k = 0; k < 2; ++k) {
      s[i + 2 * k] = __builtin_shufflevector(t[i + k], t[i + 2 + k], 0, 1, 8, 9, 4, 5, 12, 13);
      s[i + 2 * k + 1] = __builtin_shufflevector(t[i + k], t[i + 2 + k], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int i = 0; i < 4; ++i) {
    out[i] = __builtin_shufflevector(s[i], s[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    out[i + 4] = __builtin_shufflevector(s[i], s[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace lanes

/// block: nine numbers, column by column, of k_lanes blocks, of which the first `used` go to those places.
inline void add_blocks(const Lanes* block, std::size_t used, Mat3f* blocks, const LaneInts& place) {
  static_assert(k_lanes == 8 && sizeof(Mat3f) == 9 * sizeof(float));
  Lanes by_lane[8];
  lanes::transpose(block, by_lane);
  for (std::size_t l = 0; l < used; ++l) {
    float* target = blocks[place[l]].data();
    Lanes sum;
    std::memcpy(&sum, target, sizeof sum);
    sum += by_lane[l];
    std::memcpy(target, &sum, sizeof sum);
    target[8] += block[8][l];
  }
}

/// Of the diagonal blocks of k_lanes vertices.
inline LaneInts diagonal_places(std::span<const int> diagonal, const LaneInts& vertex) {
  LaneInts out;
  for (int l = 0; l < k_lanes; ++l) out[l] = diagonal[static_cast<std::size_t>(vertex[l])];
  return out;
}

/// Transposes the blocks of the lanes where turned is -1: those that are the lower ones of their elements' two.
inline void transpose_where(const LaneInts& turned, Lanes* block) {
  for (int column = 0; column < 3; ++column)
    for (int row = column + 1; row < 3; ++row) {
      Lanes &a = block[3 * column + row], &b = block[3 * row + column];
      const Lanes other = turned ? b : a;
      b = turned ? a : b;
      a = other;
    }
}

}  // namespace ft::inline solvers

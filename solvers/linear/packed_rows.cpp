#include "solvers/linear/packed_rows.h"

#include <cstring>

#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_rows = 1024;  ///< per block of a loop
constexpr std::size_t k_spare = 8;    ///< floats past the last block that product() may read

struct Columns {
  detail::Four column[3];  ///< the fourth lane is anything
};

/// The block, or its transpose.
Columns columns_of(const Mat3f& block, bool transposed) {
  const float* p = block.data();
  const Columns c{{detail::load_four(p), detail::load_four(p + 3), detail::load_four(p + 6)}};
  if (!transposed) return c;
  const detail::Four low = __builtin_shufflevector(c.column[0], c.column[1], 0, 4, 1, 5);
  const detail::Four high = __builtin_shufflevector(c.column[0], c.column[1], 2, 6, 3, 7);
  return {{__builtin_shufflevector(low, c.column[2], 0, 1, 4, 7), __builtin_shufflevector(low, c.column[2], 2, 3, 5, 7),
           __builtin_shufflevector(high, c.column[2], 0, 1, 6, 7)}};
}

/// Four lanes, of which the last is written over by what comes next.
void store_more(float* p, const detail::Four& v) {
  std::memcpy(p, &v, 4 * sizeof(float));
}
void store(float* p, const detail::Four& v) {
  std::memcpy(p, &v, 3 * sizeof(float));
}

}  // namespace

void PackedRows::fill(const BlockMatrix& matrix) {
  const BlockPattern& p = *matrix.pattern;
  pattern_ = &p;
  values_.resize(9 * p.column.size() + k_spare);
  parallel_for(at(p.vertex_count()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto block = [&](int k) {
        return columns_of(matrix.blocks[at(p.place[at(k)])], p.column[at(k)] < static_cast<int>(i));
      };
      int k = p.row_start[i];
      float* to = values_.data() + 9 * at(k);
      for (; k + 1 < p.row_start[i + 1]; k += 2, to += 18) {
        const Columns a = block(k), b = block(k + 1);
        for (int c = 0; c < 3; ++c) {
          store_more(to + 6 * c, a.column[c]);
          if (c < 2)
            store_more(to + 6 * c + 3, b.column[c]);
          else
            store(to + 6 * c + 3, b.column[c]);
        }
      }
      if (k == p.row_start[i + 1]) continue;
      const Columns last = block(k);
      store_more(to, last.column[0]), store_more(to + 3, last.column[1]), store(to + 6, last.column[2]);
    }
  });
}

}  // namespace ft

// A row of a symmetric matrix, of which the half on and above the diagonal is there, times a vector. Without a copy of
// the other half: it would be as much again to read from memory, where blocks of earlier rows are still in the cache.
#pragma once

#ifdef __FMA__
#include <immintrin.h>
#endif

#include "solvers/linear/block_matrix.h"

namespace ft::inline solvers {

using Vec4f = Eigen::Vector4f;  ///< a 3-vector padded for aligned loads; the fourth entry is always zero or ignored

/// Row times x (one per vertex). The fourth entry is zero.
Vec4f row_product(const BlockMatrix& matrix, std::size_t row, const Vec4f* x);

namespace products {

using Four = float __attribute__((vector_size(16), may_alias));
using Eight = float __attribute__((vector_size(32), may_alias));
using UnalignedFour = float __attribute__((vector_size(16), may_alias, aligned(4)));
using UnalignedEight = float __attribute__((vector_size(32), may_alias, aligned(4)));

inline Four load_four(const float* p) {
  return *reinterpret_cast<const UnalignedFour*>(p);
}
inline Eight load_eight(const float* p) {
  return *reinterpret_cast<const UnalignedEight*>(p);
}

/// a b + c, rounded once where the machine does that.
inline Four multiply_add(const Four& a, const Four& b, const Four& c) {
#ifdef __FMA__
  return reinterpret_cast<Four>(
      _mm_fmadd_ps(reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b), reinterpret_cast<__m128>(c)));
#else
  return a * b + c;
#endif
}
inline Eight multiply_add(const Eight& a, const Eight& b, const Eight& c) {
#ifdef __FMA__
  return reinterpret_cast<Eight>(
      _mm256_fmadd_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(c)));
#else
  return a * b + c;
#endif
}

/// What the row has on and above the diagonal: three loads of eight floats, of which six are used, take two blocks.
[[gnu::always_inline]] inline Four upper_product(const BlockMatrix& matrix, std::size_t row, const Vec4f* x) {
  const BlockPattern& p = *matrix.pattern;
  const int* column = p.column.data() + p.diagonal[row];
  const int* const end = p.column.data() + p.diagonal[row + 1];
  const float* value = matrix.blocks[at(p.diagonal[row])].data();
  Eight sum[3]{};
  for (; column + 1 < end; column += 2, value += 18) {
    const Four& a = *reinterpret_cast<const Four*>(x + column[0]);
    const Four& b = *reinterpret_cast<const Four*>(x + column[1]);
    const Eight both = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    sum[0] = multiply_add(load_eight(value), __builtin_shufflevector(both, both, 0, 0, 0, 1, 1, 1, 0, 0), sum[0]);
    sum[1] = multiply_add(load_eight(value + 6), __builtin_shufflevector(both, both, 2, 2, 2, 4, 4, 4, 2, 2), sum[1]);
    sum[2] = multiply_add(load_eight(value + 12), __builtin_shufflevector(both, both, 5, 5, 5, 6, 6, 6, 5, 5), sum[2]);
  }
  const Eight pairs = sum[0] + sum[1] + sum[2];  // the last two lanes hold what nobody looks at
  Four whole = __builtin_shufflevector(pairs, pairs, 0, 1, 2, 7) + __builtin_shufflevector(pairs, pairs, 3, 4, 5, 7);
  if (column < end) {
    const Four& a = *reinterpret_cast<const Four*>(x + column[0]);
    whole += load_four(value) * a[0] + load_four(value + 3) * a[1] + load_four(value + 6) * a[2];
  }
  return whole;
}

/// What it has below: entry c of a transposed block's product is the sum over the lanes of its column c times the
/// vector, and sums over lanes can wait until all blocks are added up.
[[gnu::always_inline]] inline Four lower_product(const BlockMatrix& matrix, std::size_t row, const Vec4f* x) {
  const BlockPattern& p = *matrix.pattern;
  const BlockPattern::Mirrored* k = p.below.data() + p.below_start[row];
  const BlockPattern::Mirrored* const end = p.below.data() + p.below_start[row + 1];
  const float* const values = matrix.blocks[0].data();
  Four sum[3]{};
  const auto add = [&](const BlockPattern::Mirrored& from) {
    const float* value = values + 9 * at(from.place);
    const Four& a = *reinterpret_cast<const Four*>(x + from.row);
    sum[0] = multiply_add(load_four(value), a, sum[0]);
    sum[1] = multiply_add(load_four(value + 3), a, sum[1]);
    sum[2] = multiply_add(load_four(value + 6), a, sum[2]);
  };
  for (; k + 1 < end; k += 2) add(k[0]), add(k[1]);
  if (k < end) add(*k);
  // Transposed: columns of the three sums, whose last lanes hold what nobody looks at.
  const Four low = __builtin_shufflevector(sum[0], sum[1], 0, 4, 1, 5);
  const Four high = __builtin_shufflevector(sum[0], sum[1], 2, 6, 3, 7);
  return __builtin_shufflevector(low, sum[2], 0, 1, 4, 7) + __builtin_shufflevector(low, sum[2], 2, 3, 5, 7) +
         __builtin_shufflevector(high, sum[2], 0, 1, 6, 7);
}

}  // namespace products

[[gnu::always_inline]] inline Vec4f row_product(const BlockMatrix& matrix, std::size_t row, const Vec4f* x) {
  using namespace products;
  const Four whole = upper_product(matrix, row, x) + lower_product(matrix, row, x);
  Vec4f out;
  *reinterpret_cast<Four*>(out.data()) = __builtin_shufflevector(whole, Four{}, 0, 1, 2, 4);
  return out;
}

}  // namespace ft::inline solvers

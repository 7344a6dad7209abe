// A symmetric matrix once more, whole rows laid out for products with a vector: two blocks side by side, column by
// column, so that three loads of eight floats take both.
#pragma once

#ifdef __FMA__
#include <immintrin.h>
#endif

#include <vector>

#include "solvers/linear/block_matrix.h"

namespace ft {

using Vec4f = Eigen::Vector4f;  ///< a 3-vector padded for aligned loads; the fourth entry is always zero or ignored

class PackedRows {
 public:
  /// Takes over the values. The matrix's pattern must outlive this.
  void fill(const BlockMatrix& matrix);
  /// Row times x (one per vertex). The fourth entry is zero.
  Vec4f product(std::size_t row, const Vec4f* x) const;

 private:
  const BlockPattern* pattern_ = nullptr;
  std::vector<float> values_;  ///< nine per block, and some more: the last load reads past its block
};

namespace detail {

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
inline Eight multiply_add(const Eight& a, const Eight& b, const Eight& c) {
#ifdef __FMA__
  return reinterpret_cast<Eight>(
      _mm256_fmadd_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(c)));
#else
  return a * b + c;
#endif
}

}  // namespace detail

[[gnu::always_inline]] inline Vec4f PackedRows::product(std::size_t row, const Vec4f* x) const {
  using namespace detail;
  const int* column = pattern_->column.data() + pattern_->row_start[row];
  const int* const end = pattern_->column.data() + pattern_->row_start[row + 1];
  const float* value = values_.data() + 9 * at(pattern_->row_start[row]);
  Eight sum[3]{};
  for (; column + 1 < end; column += 2, value += 18) {
    const Four& a = *reinterpret_cast<const Four*>(x + column[0]);
    const Four& b = *reinterpret_cast<const Four*>(x + column[1]);
    const Eight both = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    sum[0] = multiply_add(load_eight(value), __builtin_shufflevector(both, both, 0, 0, 0, 4, 4, 4, 0, 0), sum[0]);
    sum[1] = multiply_add(load_eight(value + 6), __builtin_shufflevector(both, both, 1, 1, 1, 5, 5, 5, 1, 1), sum[1]);
    sum[2] = multiply_add(load_eight(value + 12), __builtin_shufflevector(both, both, 2, 2, 2, 6, 6, 6, 2, 2), sum[2]);
  }
  const Eight pairs = sum[0] + sum[1] + sum[2];  // the last two lanes hold what nobody looks at
  Four whole = __builtin_shufflevector(pairs, pairs, 0, 1, 2, 7) + __builtin_shufflevector(pairs, pairs, 3, 4, 5, 7);
  if (column < end) {
    const Four& a = *reinterpret_cast<const Four*>(x + column[0]);
    whole += load_four(value) * a[0] + load_four(value + 3) * a[1] + load_four(value + 6) * a[2];
  }
  whole = __builtin_shufflevector(whole, Four{}, 0, 1, 2, 4);
  Vec4f out;
  *reinterpret_cast<Four*>(out.data()) = whole;
  return out;
}

}  // namespace ft

// L D L^T of a symmetric banded matrix, without pivoting: signs of D are those of the eigenvalues (Sylvester). In rows
// of the lower triangle.
#pragma once

#include <span>
#include <vector>

#include "solvers/hair/lanes.h"

namespace ft::inline solvers {

/// Unknowns of three positions and a turn a vertex reach over two vertices and a half.
inline constexpr int k_band = 10;

template <class T>
class BandedMatrix {
 public:
  /// All zero.
  void reset(int size) { rows_.assign(at(size) * (k_band + 1), T{}); }
  int size() const { return static_cast<int>(rows_.size()) / (k_band + 1); }
  /// j <= i, i - j <= k_band.
  T& operator()(int i, int j) { return rows_[at(i) * (k_band + 1) + at(i - j)]; }
  const T& operator()(int i, int j) const { return rows_[at(i) * (k_band + 1) + at(i - j)]; }

  /// In place, of rows from `first` on; what is before does not count. Returns the smallest pivot.
  T factor(int first) {
    T least = all_lanes<T>(1e300);
    const int n = size();
    T scaled[k_band];
    for (int i = first; i < n; ++i) {
      const int begin = std::max(first, i - k_band);
      for (int j = begin; j < i; ++j) {
        T sum = (*this)(i, j);
        const int from = std::max(begin, j - k_band);
        for (int k = from; k < j; ++k) sum -= scaled[k - begin] * (*this)(j, k);
        scaled[j - begin] = sum;  // L times D
      }
      T pivot = (*this)(i, i);
      for (int j = begin; j < i; ++j) {
        const T value = scaled[j - begin] * inverse_[at(j)];
        (*this)(i, j) = value;
        pivot -= value * scaled[j - begin];
      }
      (*this)(i, i) = pivot;
      if (inverse_.size() < at(n)) inverse_.resize(at(n));
      inverse_[at(i)] = all_lanes<T>(1) / pivot;
      least = smaller(least, pivot);
    }
    return least;
  }
  /// After factor(): x becomes the solution of A x = x.
  void solve(int first, std::span<T> x) const {
    const int n = size();
    for (int i = first; i < n; ++i)
      for (int j = std::max(first, i - k_band); j < i; ++j) x[at(i)] -= (*this)(i, j) * x[at(j)];
    for (int i = first; i < n; ++i) x[at(i)] *= inverse_[at(i)];
    for (int i = n - 1; i >= first; --i)
      for (int j = std::max(first, i - k_band); j < i; ++j) x[at(j)] -= (*this)(i, j) * x[at(i)];
  }

 private:
  std::vector<T> rows_, inverse_;
};

}  // namespace ft::inline solvers

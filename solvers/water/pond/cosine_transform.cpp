#include "solvers/water/pond/cosine_transform.h"

#include <algorithm>
#include <numbers>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_columns_at_once = 8;  ///< a cache line of doubles
constexpr std::size_t k_row_pairs = 8;        ///< in a block

}  // namespace

RowCosines::RowCosines(int n)
    : n_(static_cast<std::size_t>(n)), forward_(n_, false), inverse_(n_, true), turn_(n_ + 1) {
  CHECK(n > 0 && n % 2 == 0);
  for (std::size_t k = 0; k <= n_; ++k)
    turn_[k] = std::polar(1.0, -0.5 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n_));
}

RowCosines::Scratch RowCosines::scratch() const {
  return {forward_, inverse_, std::vector<std::complex<double>>(n_), std::vector<std::complex<double>>(n_)};
}

void RowCosines::to_waves(double* a, double* b, Scratch& s) const {
  for (std::size_t j = 0; j < n_ / 2; ++j) {
    s.in[j] = {a[2 * j], b[2 * j]};
    s.in[n_ - 1 - j] = {a[2 * j + 1], b[2 * j + 1]};
  }
  s.forward.transform(s.in.data(), s.out.data());
  const double scale = 2 / static_cast<double>(n_);
  for (std::size_t k = 0; k < n_; ++k) {
    const std::complex<double> here = s.out[k], there = std::conj(s.out[(n_ - k) % n_]);
    const std::complex<double> first = 0.5 * (here + there), second = 0.5 * (here - there);
    // second is i times the transform of b
    a[k] = scale * (turn_[k].real() * first.real() - turn_[k].imag() * first.imag());
    b[k] = scale * (turn_[k].real() * second.imag() + turn_[k].imag() * second.real());
  }
  a[0] *= 0.5, b[0] *= 0.5;
}

void RowCosines::to_values(double* a, double* b, Scratch& s) const {
  s.in[0] = {a[0], b[0]};
  for (std::size_t k = 1; k < n_; ++k) {
    const double tr = turn_[k].real(), ti = -turn_[k].imag();
    const double ar = 0.5 * (tr * a[k] + ti * a[n_ - k]), ai = 0.5 * (ti * a[k] - tr * a[n_ - k]);
    const double br = 0.5 * (tr * b[k] + ti * b[n_ - k]), bi = 0.5 * (ti * b[k] - tr * b[n_ - k]);
    s.in[k] = {ar - bi, ai + br};
  }
  s.inverse.transform(s.in.data(), s.out.data());
  for (std::size_t j = 0; j < n_ / 2; ++j) {
    a[2 * j] = s.out[j].real(), b[2 * j] = s.out[j].imag();
    a[2 * j + 1] = s.out[n_ - 1 - j].real(), b[2 * j + 1] = s.out[n_ - 1 - j].imag();
  }
}

CosineTransform::CosineTransform(int nx, int nz, int stride)
    : nx_(static_cast<std::size_t>(nx)),
      nz_(static_cast<std::size_t>(nz)),
      stride_(static_cast<std::size_t>(stride)),
      along_x_(nx),
      along_z_(nz) {}

void CosineTransform::rows(std::span<double> grid, bool forward) const {
  parallel_for(nz_ / 2, k_row_pairs, [&](std::size_t begin, std::size_t end) {
    RowCosines::Scratch s = along_x_.scratch();
    for (std::size_t pair = begin; pair < end; ++pair) {
      double *a = grid.data() + 2 * pair * stride_, *b = a + stride_;
      // Nothing becomes nothing: splashes fill few rows.
      const auto none = [&](const double* row) { return std::all_of(row, row + nx_, [](double x) { return x == 0; }); };
      if (none(a) && none(b)) continue;
      forward ? along_x_.to_waves(a, b, s) : along_x_.to_values(a, b, s);
    }
  });
}

void CosineTransform::columns(std::span<double> grid, bool forward) const {
  parallel_for(nx_, k_columns_at_once, [&](std::size_t begin, std::size_t end) {
    RowCosines::Scratch s = along_z_.scratch();
    std::vector<double> buffer(k_columns_at_once * nz_);
    for (std::size_t j = 0; j < nz_; ++j)
      for (std::size_t i = begin; i < end; ++i) buffer[(i - begin) * nz_ + j] = grid[j * stride_ + i];
    for (std::size_t i = 0; i < end - begin; i += 2) {
      double *a = buffer.data() + i * nz_, *b = a + nz_;
      forward ? along_z_.to_waves(a, b, s) : along_z_.to_values(a, b, s);
    }
    for (std::size_t j = 0; j < nz_; ++j)
      for (std::size_t i = begin; i < end; ++i) grid[j * stride_ + i] = buffer[(i - begin) * nz_ + j];
  });
}

void CosineTransform::to_waves(std::span<double> grid) const {
  CHECK(grid.size() == stride_ * nz_);
  rows(grid, true);
  columns(grid, true);
}

void CosineTransform::to_values(std::span<double> grid) const {
  CHECK(grid.size() == stride_ * nz_);
  rows(grid, false);
  columns(grid, false);
}

}  // namespace ft::inline solvers

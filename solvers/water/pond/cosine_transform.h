// Between heights on a grid and cosine waves between walls, for the pond: the type-2 cosine transform of Makhoul (1980)
// through a complex Fourier transform, two rows at a time. Plain code of fixed order: the same bytes from every run and
// any number of threads.
#pragma once

#include <complex>
#include <kissfft/kissfft.hh>
#include <span>
#include <vector>

namespace ft::inline solvers {

/// Of rows of n values; n even, > 0.
class RowCosines {
 public:
  explicit RowCosines(int n);
  struct Scratch {
    kissfft<double> forward, inverse;
    std::vector<std::complex<double>> in, out;
  };
  Scratch scratch() const;
  /// values at (i + 1/2) / n to coefficients: value = sum over k of c_k cos(pi k (i + 1/2) / n). Of two rows, in place.
  void to_waves(double* a, double* b, Scratch& s) const;
  void to_values(double* a, double* b, Scratch& s) const;

 private:
  std::size_t n_;
  kissfft<double> forward_, inverse_;
  std::vector<std::complex<double>> turn_;  ///< exp(-i pi k / 2n)
};

/// Of grids of nx columns and nz rows, row after row, `stride` numbers from one to the next. nx and nz even.
class CosineTransform {
 public:
  CosineTransform(int nx, int nz, int stride);
  void to_waves(std::span<double> grid) const;
  void to_values(std::span<double> grid) const;

 private:
  void rows(std::span<double> grid, bool forward) const;
  void columns(std::span<double> grid, bool forward) const;
  std::size_t nx_, nz_, stride_;
  RowCosines along_x_, along_z_;
};

}  // namespace ft::inline solvers

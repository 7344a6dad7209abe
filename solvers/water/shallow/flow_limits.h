// The two limits of the scheme: of slopes, and of what leaves a cell. For flow*.cpp.
#pragma once

#include <algorithm>

namespace ft::inline solvers {

/// Of two differences one after another: their harmonic mean, 0 at an extremum (van Leer 1974).
inline double van_leer(double a, double b) {
  const double p = a * b;
  return p > 0 ? 2 * p / (a + b) : 0.0;
}

/// By how much what leaves a cell is cut [1].
inline double draining(double h, double out) {
  const double share = h / std::max(out, 1e-300) * (1 - 1e-14);
  return out > h ? share : 1.0;
}

}  // namespace ft::inline solvers

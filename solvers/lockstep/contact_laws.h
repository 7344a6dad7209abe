// Contact's barrier and friction's potential between cords and what they meet (Li et al. 2020, incremental potential
// contact).
#pragma once

#include <cmath>
#include <limits>

namespace ft::inline solvers {

struct Barrier {
  double energy = 0, slope = 0, curvature = 0;
};

/// -k (d - r)^2 ln(d / r) below the reach r [m], with its slope and curvature by d. k: N/m.
inline Barrier barrier(double d, double reach, double k) {
  if (d >= reach) return {};
  if (d <= 0) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double in = d - reach, log = std::log(d / reach);
  return {-k * in * in * log, -k * (2 * in * log + in * in / d), -k * (2 * log + 4 * in / d - in * in / (d * d))};
}

/// Friction's potential by slip, over the full force, with its slope and curvature (eq. 15). full: slip from which the
/// force is full [m].
inline double friction_energy(double slip, double full) {
  return slip >= full ? slip : slip * slip / full * (1 - slip / (3 * full)) + full / 3;
}
inline double friction_slope(double slip, double full) {
  return slip >= full ? 1 : slip / full * (2 - slip / full);
}
inline double friction_curvature(double slip, double full) {
  return slip >= full ? 0 : 2 / full * (1 - slip / full);
}

}  // namespace ft::inline solvers

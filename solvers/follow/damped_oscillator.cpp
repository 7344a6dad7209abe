#include "solvers/follow/damped_oscillator.h"

#include <cmath>

namespace ft::inline solvers {
namespace {

/// sin(a) / a and sinh(a) / a, exact at 0.
double sinc(double a) {
  return std::abs(a) < 1e-4 ? 1 - a * a / 6 : std::sin(a) / a;
}
double sinhc(double a) {
  return std::abs(a) < 1e-4 ? 1 + a * a / 6 : std::sinh(a) / a;
}

}  // namespace

void DampedOscillator::advance(Lag& lag, double dt) const {
  // x(t) = e^(-zwt) (x0 C + (v0 + z w x0) S), with C = cos(at), S = sin(at) / a and a = w sqrt(1 - z^2); hyperbolic
  // above critical damping.
  const double decay = zeta * omega, square = omega * omega * (1 - zeta * zeta);
  const double a = std::sqrt(std::abs(square));
  double c = std::cos(a * dt), s = dt * sinc(a * dt), fall = std::exp(-decay * dt);
  if (square < 0) {
    if (a * dt > 30) {  // the fast root is gone; what is left is e^((a - zw) t) / 2, without overflow
      fall = 0.5 * std::exp((a - decay) * dt);
      c = 1, s = 1 / a;
    } else {
      c = std::cosh(a * dt), s = dt * sinhc(a * dt);
    }
  }
  const Vec3 x = lag.position, v = lag.velocity;
  lag.position = fall * (c * x + s * (v + decay * x));
  lag.velocity = fall * (c * v - s * (decay * v + omega * omega * x));
}

}  // namespace ft::inline solvers

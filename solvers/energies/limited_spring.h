// A spring that pulls no harder than a limit: quadratic up to it, linear beyond. What holds by it slips instead of
// tearing.
#pragma once

namespace ft::inline solvers {

struct LimitedSpring {
  double energy = 0;  ///< J
  double force = 0;   ///< N
  double secant = 0;  ///< force / stretch [N/m]; never below the true stiffness, and finite at no stretch
};

/// stretch in m; stiffness in N/m and limit in N, both above 0. A spring that is pushed together (stretch below 0) does
/// nothing.
inline LimitedSpring limited_spring(double stretch, double stiffness, double limit) {
  if (stretch < 0) return {};
  const double elastic = limit / stiffness;
  if (stretch <= elastic) return {0.5 * stiffness * stretch * stretch, stiffness * stretch, stiffness};
  return {limit * (stretch - 0.5 * elastic), limit, limit / stretch};
}

}  // namespace ft::inline solvers

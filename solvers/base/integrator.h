// Implicit multistep formulas with variable steps. The cloth's is BDF2 with a quarter of BDF3 (blended BDF: Nyukhtikov
// et al. 2003, J. Comput. Phys. 189; half of it is Park's method, 1975, J. Appl. Mech. 42): stable for all oscillations
// like BDF2, with half its loss of amplitude where oscillations are slow, and the rest of it where they are fast and
// cloth has to come to rest. With less history BDF2, with none implicit Euler.
#pragma once

namespace ft::inline solvers {

/// x_1 = a x_0 - b x_-1 + c x_-2 + beta h v_1, and the same for v.
struct IntegratorWeights {
  double a = 1, b = 0, c = 0, beta = 1;
};

/// BDF2 where the ratio of steps allows it: beyond 2 it is not zero-stable (Hairer, Norsett, Wanner 1993, III.5).
/// h_previous 0: there is no history.
inline IntegratorWeights bdf2_weights(double h, double h_previous) {
  if (h_previous <= 0 || h > 2 * h_previous) return {};
  const double w = h / h_previous;
  return {(1 + w) * (1 + w) / (1 + 2 * w), w * w / (1 + 2 * w), 0, (1 + w) / (1 + 2 * w)};
}

/// The blend where neither ratio of steps exceeds 1.5, else BDF2's weights. h_older is the step before h_previous, 0:
/// unknown.
inline IntegratorWeights blended_weights(double h, double h_previous, double h_older) {
  constexpr double k_most_growth = 1.5, k_of_bdf3 = 0.25;
  if (h_older <= 0 || h > k_most_growth * h_previous || h_previous > k_most_growth * h_older)
    return bdf2_weights(h, h_previous);
  // The slope at the end by divided differences: BDF2's, and a share of what a fourth point adds to it.
  const double two = h + h_previous, earlier = h_previous + h_older, third = k_of_bdf3 * h * two / (two + h_older);
  const double newest = 1 + h / two + third / two;                 // of f[1,0]
  const double middle = -h / two - third / two - third / earlier;  // of f[0,-1]
  const double oldest = third / earlier;                           // of f[-1,-2]
  const double x_0 = middle / h_previous - newest / h, x_m1 = oldest / h_older - middle / h_previous;
  const double beta = 1 / newest;
  return {-x_0 * beta * h, x_m1 * beta * h, oldest / h_older * beta * h, beta};
}

}  // namespace ft::inline solvers

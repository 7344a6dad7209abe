// BDF2 with variable steps, implicit Euler where there is no history or the ratio of steps exceeds 2, beyond which BDF2
// is not zero-stable (Hairer, Norsett, Wanner 1993, III.5).
#pragma once

namespace ft {

/// x_1 = a x_0 - b x_-1 + beta h v_1, and the same for v.
struct IntegratorWeights {
  double a = 1, b = 0, beta = 1;
};

/// h_previous 0: there is no history.
inline IntegratorWeights integrator_weights(double h, double h_previous, bool bdf2) {
  if (!bdf2 || h_previous <= 0 || h > 2 * h_previous) return {};
  const double w = h / h_previous;
  return {(1 + w) * (1 + w) / (1 + 2 * w), w * w / (1 + 2 * w), (1 + w) / (1 + 2 * w)};
}

}  // namespace ft

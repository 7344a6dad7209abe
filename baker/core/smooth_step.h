// From 0 to 1 without a kink at either end.
#pragma once

#include <algorithm>

namespace ft {

/// 3 s^2 - 2 s^3 of the share s, which is clamped to 0..1 [1].
constexpr double smooth_step(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace ft

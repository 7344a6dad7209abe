// What no motion explains: from how far on a body, or a part of it, has been put elsewhere between two moments.
#pragma once

#include <algorithm>

namespace ft::inline io {

/// How far a body of `size` [m] has to be from where its motion before, and its motion after, would have it `time` [s]
/// later, for a jump [m]. Leaving the expected way by D within t and being back to the expected velocity takes an
/// acceleration of 4 D / t2, and above 80 g nobody is alive; and what is shorter than a quarter of the body's size is
/// no jump at any frame rate: cloth survives it.
inline double least_jump(double size, double time) {
  return std::max(0.25 * size, 0.25 * 800 * time * time);
}

/// Limbs accelerate so many times as much as bodies do.
inline constexpr double k_limb_jump = 1.6;

}  // namespace ft::inline io

// How waves are felt under water: exp(-k s), plain code that the compiler does four at a time.
#pragma once

#include <bit>
#include <cstdint>

namespace ft::inline solvers {

/// exp(-40) is beyond the last digit of what it is added to: k s from which on a wave is not felt at all.
inline constexpr double k_nothing = 40;

/// exp(-x) for x >= 0, to 1e-12; zero beyond 700.
inline double decay(double x) {
  constexpr double shift = 6755399441055744.0;  // rounds to a whole number, kept in the low bits
  const double y = -(x < 700 ? x : 700);
  const double t = y * 1.4426950408889634 + shift;
  const double n = t - shift;
  const double r = (y - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  double p = 1.0 / 39916800;
  p = p * r + 1.0 / 3628800, p = p * r + 1.0 / 362880, p = p * r + 1.0 / 40320, p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720, p = p * r + 1.0 / 120, p = p * r + 1.0 / 24, p = p * r + 1.0 / 6;
  p = p * r + 0.5, p = p * r + 1, p = p * r + 1;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p) + (std::bit_cast<std::uint64_t>(t) << 52));
}

}  // namespace ft::inline solvers

// Curve: one animated number as animation programs draw it, with handles at its keys and a rule for what lies before
// the first key and after the last one. Evaluated as it is at any time; never turned into dense keys.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ft::inline io {

/// How a curve goes from a key to the next one.
enum class CurveInterpolation : std::uint8_t { k_constant, k_constant_next, k_linear, k_cubic };

/// What a curve does outside of its keys.
enum class CurveInfinity : std::uint8_t { k_constant, k_slope, k_repeat, k_mirror, k_repeat_relative };

/// Bezier handles of a key, as distances from it: time [s] is at least 0 on both sides, value is signed along time
/// (a rising curve has positive ones on both sides).
struct CurveHandles {
  double before_time = 0, before_value = 0, after_time = 0, after_value = 0;
};

struct CurveEnd {
  CurveInfinity rule = CurveInfinity::k_constant;
  std::int32_t count = -1;  ///< repetitions; -1: for ever
};

struct Curve {
  std::vector<double> times;   ///< s, none before the one in front of it; of equal ones the last holds
  std::vector<double> values;  ///< one per key
  std::vector<CurveInterpolation> interpolation;  ///< one per key, to the next one; empty: straight lines
  std::vector<CurveHandles> handles;              ///< one per key; empty where nothing is cubic and no end has a slope
  CurveEnd before, after;

  bool empty() const { return times.empty(); }
  /// Value at a time [s]; 0 without keys.
  double at(double time) const;

 private:
  double inside(double time) const;
  double outside(double time) const;
};

/// The parameter t in 0..1 at which a Bezier curve from 0 to 1 with inner abscissas x1 and x2 in 0..1 is at x.
double bezier_parameter(double x1, double x2, double x);

}  // namespace ft::inline io

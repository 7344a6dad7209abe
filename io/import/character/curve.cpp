#include "io/import/character/curve.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

/// Ends of a repeated stretch are found to this fraction of a second, so that a time that falls on one is on it.
constexpr double k_ticks = 46186158000.0;

}  // namespace

double bezier_parameter(double x1, double x2, double x) {
  if (!(x > 0)) return 0;
  if (!(x < 1)) return 1;
  const double a = 3 * x1 - 3 * x2 + 1, b = 3 * x2 - 6 * x1, c = 3 * x1;
  double low = 0, high = 1, t = x;
  for (int step = 0; step < 100; ++step) {  // Newton, kept between bounds that close by halves at least
    const double off = ((a * t + b) * t + c) * t - x;
    if (off == 0) return t;
    (off < 0 ? low : high) = t;
    const double slope = (3 * a * t + 2 * b) * t + c;
    double next = t - off / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-16) return next;
    t = next;
  }
  return t;
}

double Curve::inside(double time) const {
  const auto next = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (next == 0) return values.front();
  const std::size_t last = next - 1;
  if (next == times.size() || times[last] == time) return values[last];
  const CurveInterpolation how = interpolation.empty() ? CurveInterpolation::k_linear : interpolation[last];
  if (how == CurveInterpolation::k_constant) return values[last];
  if (how == CurveInterpolation::k_constant_next) return values[next];
  const double span = times[next] - times[last], u = (time - times[last]) / span;
  const double y0 = values[last], y3 = values[next];
  if (how == CurveInterpolation::k_linear || handles.empty()) return y0 * (1 - u) + y3 * u;
  const CurveHandles &a = handles[last], &b = handles[next];
  const double x1 = std::clamp(a.after_time / span, 0.0, 1.0), x2 = std::clamp(1 - b.before_time / span, 0.0, 1.0);
  const double t = bezier_parameter(x1, x2, u), s = 1 - t;
  const double y1 = y0 + a.after_value, y2 = y3 - b.before_value;
  return s * s * s * y0 + 3 * s * t * (s * y1 + t * y2) + t * t * t * y3;
}

double Curve::outside(double time) const {
  const bool is_before = time < times.front();
  const CurveEnd& end = is_before ? before : after;
  const double held = is_before ? values.front() : values.back();
  if (end.rule == CurveInfinity::k_constant || (end.rule != CurveInfinity::k_slope && end.count == 0)) return held;
  if (end.rule == CurveInfinity::k_slope) {
    if (handles.empty()) {
      const std::size_t n = times.size(), a = is_before ? 0 : n - 2;
      const double span = times[a + 1] - times[a];
      const bool steps = !interpolation.empty() && interpolation[a] < CurveInterpolation::k_linear;
      if (!(span > 0) || steps) return held;
      return held + (values[a + 1] - values[a]) / span * (time - (is_before ? times.front() : times.back()));
    }
    const CurveHandles& h = is_before ? handles.front() : handles.back();
    const double run = is_before ? h.after_time : h.before_time, rise = is_before ? h.after_value : h.before_value;
    return run > 0 ? held + rise / run * (time - (is_before ? times.front() : times.back())) : held;
  }
  const double first = std::round(times.front() * k_ticks), last = std::round(times.back() * k_ticks);
  const double span = last - first, now = time * k_ticks;
  if (!(span >= 1)) return held;
  const double beyond = is_before ? first - now : now - last;
  double turns = std::floor(beyond / span);
  double into = beyond - turns * span;
  if (end.count > 0 && turns >= end.count) turns = end.count - 1, into = span;
  if (end.rule == CurveInfinity::k_mirror && std::fmod(turns, 2) == 0) into = span - into;
  if (is_before) into = span - into;
  const double value = inside((first + into) / k_ticks);
  if (end.rule != CurveInfinity::k_repeat_relative) return value;
  return value + (is_before ? -1 : 1) * (values.back() - values.front()) * (turns + 1);
}

double Curve::at(double time) const {
  if (times.empty()) return 0;
  if (times.size() == 1) return values.front();
  return time < times.front() || time > times.back() ? outside(time) : inside(time);
}

}  // namespace ft::inline io

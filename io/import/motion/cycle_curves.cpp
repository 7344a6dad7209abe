#include "io/import/motion/cycle_curves.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

constexpr double k_near = 1e-6;  ///< a key so near to an end of the cycle lies on it [s]

void push(Curve& curve, double time, double value, CurveInterpolation how, const CurveHandles& handles) {
  curve.times.push_back(time), curve.values.push_back(value);
  curve.interpolation.push_back(how), curve.handles.push_back(handles);
}

/// Whether the curve may jump: at a key that is held, or where it begins anew.
bool may_jump(const Curve& curve) {
  const auto begins_anew = [](const CurveEnd& end) { return end.rule == CurveInfinity::k_repeat; };
  return begins_anew(curve.before) || begins_anew(curve.after) ||
         std::any_of(curve.interpolation.begin(), curve.interpolation.end(),
                     [](CurveInterpolation how) { return how < CurveInterpolation::k_linear; });
}

/// Keys on both sides of the largest jump within (low, high], at the first time that has the new value; none where the
/// curve only goes on.
void push_jump(const Curve& curve, double low, double high, Curve& out) {
  double before = curve.at(low), after = curve.at(high);
  const double end = high, whole = std::abs(after - before);
  for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high)) {
    const double value = curve.at(middle);
    if (std::abs(value - before) > std::abs(after - value))
      high = middle, after = value;
    else
      low = middle, before = value;
  }
  if (!(std::abs(after - before) > 1e-3 * whole)) return;
  push(out, high, before, CurveInterpolation::k_linear, {});
  if (high < end) push(out, high, after, CurveInterpolation::k_linear, {});
}

/// With keys at both ends.
Curve one_cycle(const Curve& curve, double start, double end) {
  Curve out;
  const bool at_start = curve.times.front() <= start + k_near, at_end = curve.times.back() >= end - k_near;
  const bool within = curve.times.front() >= start - k_near && curve.times.back() <= end + k_near;
  const bool held = (at_start || curve.before.rule == CurveInfinity::k_constant) &&
                    (at_end || curve.after.rule == CurveInfinity::k_constant);
  if (!within || !held) {
    const int count = std::max(1, static_cast<int>(std::ceil((end - start) * k_curve_samples)));
    const bool jumps = may_jump(curve);
    const auto time_of = [&](int k) { return start + (end - start) * k / count; };
    for (int k = 0; k <= count; ++k) {
      const double time = time_of(k);
      if (jumps && k > 0) push_jump(curve, time_of(k - 1), time, out);
      push(out, time, curve.at(time), CurveInterpolation::k_linear, {});
    }
    return out;
  }
  if (!at_start) push(out, start, curve.values.front(), CurveInterpolation::k_constant, {});
  for (std::size_t k = 0; k < curve.times.size(); ++k)
    push(out, std::clamp(curve.times[k], start, end), curve.values[k],
         k + 1 == curve.times.size()   ? CurveInterpolation::k_constant
         : curve.interpolation.empty() ? CurveInterpolation::k_linear
                                       : curve.interpolation[k],
         curve.handles.empty() ? CurveHandles{} : curve.handles[k]);
  if (!at_end) push(out, end, curve.values.back(), CurveInterpolation::k_constant, {});
  return out;
}

}  // namespace

Curve repeated_curve(const Curve& curve, const RepeatedSpan& span) {
  if (curve.times.size() < 2) return curve;
  const double end = span.start + span.period;
  Curve own = one_cycle(curve, span.start, end), out;
  if (curve.handles.empty()) own.handles.clear();
  for (long n = span.first; n <= span.last; ++n) {
    for (std::size_t k = 0; k < own.times.size(); ++k) {
      const bool first = k == 0, last = k + 1 == own.times.size();
      out.times.push_back(first  ? span.begin_of(n)
                          : last ? span.begin_of(n + 1)
                                 : std::clamp(own.times[k] + static_cast<double>(n) * span.period, span.begin_of(n),
                                              span.begin_of(n + 1)));
    }
    out.values.insert(out.values.end(), own.values.begin(), own.values.end());
    out.interpolation.insert(out.interpolation.end(), own.interpolation.begin(), own.interpolation.end());
    out.handles.insert(out.handles.end(), own.handles.begin(), own.handles.end());
  }
  return out;
}

void place_cycles(const RepeatedSpan& span, std::span<const Vec3> translations, std::span<const Quat> rotations,
                  TransformStack& stack, ClipCurves& curves) {
  ElementaryTransform move, turn;
  move.kind = TransformKind::k_translate, turn.kind = TransformKind::k_rotate;
  const auto layer = static_cast<std::int32_t>(curves.layers.size());
  curves.layers.emplace_back();
  for (ElementaryTransform* element : {&move, &turn}) {
    LayeredNumbers numbers;
    numbers.layer = layer;
    for (int axis = 0; axis < 3; ++axis) {
      Curve steps;
      for (std::size_t i = 0; i < translations.size(); ++i) {
        steps.times.push_back(span.begin_of(span.first + static_cast<long>(i)));
        steps.values.push_back(element == &move ? translations[i][axis] : angles_of(rotations[i], turn.order)[axis]);
        steps.interpolation.push_back(CurveInterpolation::k_constant);
      }
      numbers.curves[at(axis)] = static_cast<std::int32_t>(curves.curves.size());
      curves.curves.push_back(std::move(steps));
    }
    element->numbers.layers = {numbers};
  }
  stack.elements.insert(stack.elements.begin(), {move, turn});
}

}  // namespace ft::inline io

#include "io/import/fbx/fbx_curves.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ft::inline io {
namespace {

// KeyAttrFlags, as the FBX SDK names them.
constexpr std::uint32_t k_constant = 0x2, k_cubic = 0x8;
constexpr std::uint32_t k_constant_next = 0x100;
constexpr std::uint32_t k_tcb = 0x200, k_user = 0x400;
constexpr std::uint32_t k_clamp = 0x1000, k_time_independent = 0x2000, k_clamp_progressive = 0x4000;
constexpr std::uint32_t k_weighted_right = 0x1000000, k_weighted_next_left = 0x2000000;
constexpr std::uint32_t k_velocities = 0x10000000 | 0x20000000;

constexpr double k_third = 1.0 / 3;
/// Values nearer to each other are one to tangents that are clamped.
constexpr double k_clamp_threshold = 0.001;

struct KeyAttributes {
  std::uint32_t flags = 0;
  std::array<double, 4> data{};  ///< right slope, next left slope, weights, velocities
  double weight_right = k_third, weight_next_left = k_third;
};

KeyAttributes attributes(std::uint32_t flags, const std::array<float, 4>& data) {
  KeyAttributes out;
  out.flags = flags;
  for (std::size_t k = 0; k < 4; ++k) out.data[k] = static_cast<double>(data[k]);
  // Two numbers of 16 bits in steps of 1/10000 share the place of one float.
  const auto packed = std::bit_cast<std::uint32_t>(data[2]);
  if ((flags & k_weighted_right) != 0) out.weight_right = (packed & 0xffff) * 1e-4;
  if ((flags & k_weighted_next_left) != 0) out.weight_next_left = (packed >> 16) * 1e-4;
  return out;
}

/// One float for each number that the file has; text files from 7.2 on write their bits as whole numbers.
std::vector<float> attribute_floats(const FbxNode* node, int version) {
  if (node == nullptr || node->properties.empty()) return {};
  if (version >= 7200)
    if (const auto* bits = std::get_if<std::vector<std::int64_t>>(&node->properties[0])) {
      std::vector<float> out;
      for (const std::int64_t b : *bits) out.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(b)));
      return out;
    }
  if (const auto* bits = std::get_if<std::vector<std::int32_t>>(&node->properties[0])) {
    std::vector<float> out;
    for (const std::int32_t b : *bits) out.push_back(std::bit_cast<float>(b));
    return out;
  }
  return fbx_floats(node);
}

struct Neighbour {
  double time = 0, value = 0;
};

/// Beyond 500 the bias of an automatic tangent adds to its slope.
double excess(double bias) {
  const double beyond = std::abs(bias) / 100 - 5;
  return beyond > 0 ? beyond * beyond * 40 : 0;
}

double automatic_slope(const Neighbour& before, const Neighbour& key, const Neighbour& after, double weight_left,
                       double weight_right, double bias, std::uint32_t flags) {
  if ((flags & k_clamp) != 0 &&
      std::min(std::abs(before.value - key.value), std::abs(after.value - key.value)) <= k_clamp_threshold)
    return 0;
  double slope = (after.value - before.value) / (after.time - before.time);
  if ((flags & k_time_independent) == 0) {
    const double left = (key.value - before.value) / (key.time - before.time);
    const double right = (after.value - key.value) / (after.time - key.time);
    const double share = (key.time - before.time) / (after.time - before.time);
    slope = 0.5 * slope + 0.5 * (left * (1 - share) + right * share);
    const double weight = std::abs(bias) / 100;
    if (weight > 1e-4) {
      const double target = bias > 0 ? right : left, way = target - slope;
      slope = slope * (1 - weight) + target * weight;
      slope += std::copysign(excess(bias), std::abs(way) > 1e-5 ? way : bias);
    }
  }
  if ((flags & k_clamp_progressive) == 0) return slope;
  const double sign = slope >= 0 ? 1 : -1;
  const auto most = [&](double rise, double run) {
    const double limit = run > 0 ? sign * rise / run : 0;
    return limit > 0 ? limit : 0.0;
  };
  return sign * std::min({sign * slope, most(key.value - before.value, weight_left * (key.time - before.time)),
                          most(after.value - key.value, weight_right * (after.time - key.time))});
}

/// At the first or the last key.
double automatic_end_slope(const Neighbour& from, const Neighbour& to, double bias, std::uint32_t flags) {
  if ((flags & k_clamp_progressive) != 0) return 0;
  if ((flags & k_clamp) != 0 && std::abs(to.value - from.value) <= k_clamp_threshold) return 0;
  double slope = (to.value - from.value) / (to.time - from.time);
  if ((flags & k_time_independent) == 0) slope += std::copysign(excess(bias), bias > 0 ? 1 : -1);
  return slope;
}

CurveEnd read_end(const FbxNode& node, const char* name) {
  CurveEnd end;
  const FbxNode* found = node.child(name);
  const FbxNode* type = found != nullptr ? found->child("Type") : nullptr;
  if (type == nullptr) return end;
  char rule = static_cast<char>(fbx_integer(*type, 0));
  if (const std::string& text = fbx_text(*type, 0); !text.empty()) rule = text[0];
  end.rule = rule == 'A'   ? CurveInfinity::k_repeat_relative
             : rule == 'K' ? CurveInfinity::k_slope
             : rule == 'M' ? CurveInfinity::k_mirror
             : rule == 'R' ? CurveInfinity::k_repeat
                           : CurveInfinity::k_constant;
  if (const FbxNode* count = found->child("Repetition"))
    end.count = static_cast<std::int32_t>(std::clamp<std::int64_t>(fbx_integer(*count, 0, -1), -1, 1'000'000'000));
  return end;
}

/// Slopes and weights on both sides of each key become handles.
void make_handles(const std::vector<KeyAttributes>& attributes, Curve& curve) {
  const std::size_t n = curve.times.size();
  curve.handles.resize(n);
  double slope_left = 0, weight_left = k_third;  // of the key at hand, as the one before it says them
  for (std::size_t i = 0; i < n; ++i) {
    const KeyAttributes& a = attributes[i];
    const Neighbour key{curve.times[i], curve.values[i]};
    const bool has_before = i > 0 && key.time > curve.times[i - 1];
    const bool has_after = i + 1 < n && curve.times[i + 1] > key.time;
    const Neighbour before = has_before ? Neighbour{curve.times[i - 1], curve.values[i - 1]} : key;
    const Neighbour after = has_after ? Neighbour{curve.times[i + 1], curve.values[i + 1]} : key;
    const auto slope = [](const Neighbour& x, const Neighbour& y) { return (y.value - x.value) / (y.time - x.time); };

    double slope_right = a.data[0], weight_right = a.weight_right;
    double next_left = a.data[1], next_weight = a.weight_next_left;
    if (curve.interpolation[i] != CurveInterpolation::k_cubic) {
      weight_right = next_weight = k_third;
      slope_right = next_left =
          curve.interpolation[i] == CurveInterpolation::k_linear && has_after ? slope(key, after) : 0;
    } else if ((a.flags & k_tcb) != 0) {
      const double factor = has_before && has_after ? 0.5 : 1;
      const double tension = a.data[0], continuity = a.data[1], bias = a.data[2];
      const double in = has_before ? slope(before, key) : 0, out = has_after ? slope(key, after) : 0;
      const double from_in = factor * (1 - tension) * (1 + bias), from_out = factor * (1 - tension) * (1 - bias);
      slope_left = from_in * (1 - continuity) * in + from_out * (1 + continuity) * out;
      slope_right = from_in * (1 + continuity) * in + from_out * (1 - continuity) * out;
      next_left = 0, next_weight = k_third;
    } else if ((a.flags & k_user) == 0) {
      if (has_before && has_after) {
        const auto one = [&](double bias) {
          return automatic_slope(before, key, after, weight_left, weight_right, bias, a.flags);
        };
        const double right = slope_right;
        const bool unbroken = std::abs(slope_left + slope_right) <= 1e-4;
        slope_right = one(right);
        slope_left = unbroken ? slope_right : one(-slope_left);
      } else if (has_before) {
        slope_left = slope_right = automatic_end_slope(before, key, -slope_left, a.flags);
      } else if (has_after) {
        slope_left = slope_right = automatic_end_slope(key, after, slope_right, a.flags);
      } else {
        slope_left = slope_right = 0;
      }
    }
    CurveHandles& h = curve.handles[i];
    if (has_before) h.before_time = weight_left * (key.time - before.time), h.before_value = h.before_time * slope_left;
    if (has_after) h.after_time = weight_right * (after.time - key.time), h.after_value = h.after_time * slope_right;
    slope_left = next_left, weight_left = next_weight;
  }
}

}  // namespace

double fbx_ticks_per_second(const FbxDocument& document) {
  constexpr double k_old = 46186158000.0, k_new = 141120000.0;
  const FbxNode* header = document.root().child("FBXHeaderExtension");
  const FbxNode* number = header != nullptr ? header->child("FBXHeaderVersion") : nullptr;
  const FbxNode* other = header != nullptr ? header->child("OtherFlags") : nullptr;
  const FbxNode* chosen = other != nullptr ? other->child("TCDefinition") : nullptr;
  if (chosen != nullptr && number != nullptr && fbx_integer(*number, 0) >= 1004)
    return fbx_integer(*chosen, 0) == 127 ? k_old : k_new;
  return document.version() < 8000 ? k_old : k_new;
}

Curve read_fbx_curve(const FbxObject& object, int version, double ticks_per_second, FbxCurveFaults& faults) {
  Curve curve;
  if (object.node == nullptr) return curve;
  const FbxNode& node = *object.node;
  const std::vector<std::int64_t> ticks = fbx_integers(node.child("KeyTime"));
  const std::vector<double> values = fbx_numbers(node.child("KeyValueFloat"));
  const std::vector<std::int64_t> flags = fbx_integers(node.child("KeyAttrFlags"));
  const std::vector<std::int64_t> runs = fbx_integers(node.child("KeyAttrRefCount"));
  const std::vector<float> data = attribute_floats(node.child("KeyAttrDataFloat"), version);
  const std::size_t n = ticks.size();
  if (n == 0 && values.empty()) return curve;
  std::int64_t covered = 0;
  for (const std::int64_t run : runs) covered += std::clamp<std::int64_t>(run, 0, static_cast<std::int64_t>(n));
  if (values.size() != n || flags.size() != runs.size() || data.size() != 4 * runs.size() ||
      covered < static_cast<std::int64_t>(n)) {
    ++faults.damaged;
    return curve;
  }
  std::vector<KeyAttributes> of_key;
  bool cubic = false, velocity = false;
  std::size_t run = 0;
  std::int64_t left = runs.empty() ? 0 : runs[0];
  for (std::size_t i = 0; i < n; ++i) {
    while (left <= 0 && run + 1 < runs.size()) left = runs[++run];
    --left;
    const double time = static_cast<double>(ticks[i]) / ticks_per_second;
    if (!curve.times.empty() && time < curve.times.back()) {
      ++faults.unordered;
      continue;
    }
    const auto f = static_cast<std::uint32_t>(flags[run]);
    curve.times.push_back(time);
    curve.values.push_back(values[i]);
    curve.interpolation.push_back((f & k_constant) != 0 ? (f & k_constant_next) != 0
                                                              ? CurveInterpolation::k_constant_next
                                                              : CurveInterpolation::k_constant
                                  : (f & k_cubic) != 0  ? CurveInterpolation::k_cubic
                                                        : CurveInterpolation::k_linear);
    cubic = cubic || curve.interpolation.back() == CurveInterpolation::k_cubic;
    velocity = velocity || (f & k_velocities) != 0;
    of_key.push_back(attributes(f, {data[4 * run], data[4 * run + 1], data[4 * run + 2], data[4 * run + 3]}));
  }
  curve.before = read_end(node, "Pre-Extrapolation");
  curve.after = read_end(node, "Post-Extrapolation");
  if (cubic) make_handles(of_key, curve);
  if (std::all_of(curve.interpolation.begin(), curve.interpolation.end(),
                  [](CurveInterpolation how) { return how == CurveInterpolation::k_linear; }))
    curve.interpolation.clear();
  if (velocity) ++faults.velocity;
  return curve;
}

}  // namespace ft::inline io

#include "io/import/character/transform_stack.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace ft::inline io {
namespace {

constexpr double k_degree = std::numbers::pi / 180;
/// A scale of 0 leaves the node that compensates for it its own: smaller scales count as this.
constexpr double k_least_scale = 1e-8;

/// The axes in the order in which they turn.
std::array<int, 3> axes_of(RotationOrder order) {
  switch (order) {
    case RotationOrder::k_xyz: return {0, 1, 2};
    case RotationOrder::k_xzy: return {0, 2, 1};
    case RotationOrder::k_yzx: return {1, 2, 0};
    case RotationOrder::k_yxz: return {1, 0, 2};
    case RotationOrder::k_zxy: return {2, 0, 1};
    case RotationOrder::k_zyx: return {2, 1, 0};
  }
  return {0, 1, 2};
}

double power(double base, double exponent) {
  if (exponent <= 0) return 1;
  if (exponent >= 1) return base;
  return std::copysign(std::pow(std::abs(base), exponent), base);
}

double at_least(double scale) {
  return std::abs(scale) < k_least_scale ? std::copysign(k_least_scale, scale) : scale;
}

double weight_at(const AnimationLayer& layer, const ClipCurves& set, double time) {
  if (layer.weight_curve < 0) return layer.weight;
  const double weight = set.curves[static_cast<std::size_t>(layer.weight_curve)].at(time) / 100;
  return weight > 0.99999 ? 1 : std::max(weight, 0.0);
}

void put_layer(const AnimationLayer& layer, double weight, const Vec3& value, TransformKind kind, RotationOrder order,
               Vec3& result) {
  if (layer.mode == LayerMode::k_override) {
    result = value;
    return;
  }
  const bool adds = layer.mode == LayerMode::k_additive;
  if (kind == TransformKind::k_scale && layer.multiplies_scales) {
    for (int k = 0; k < 3; ++k) result[k] = (adds ? result[k] : power(result[k], 1 - weight)) * power(value[k], weight);
  } else if (kind == TransformKind::k_rotate && layer.composes_rotations) {
    const Quat a = rotation_of(result, order), b = rotation_of(value, order);
    result = angles_of(adds ? Quat(a * Quat::Identity().slerp(weight, b)) : a.slerp(weight, b), order);
  } else if (adds) {
    result += weight * value;
  } else {
    result = (1 - weight) * result + weight * value;
  }
}

}  // namespace

void add_curves(const AnimatedNumbers& numbers, std::vector<std::int32_t>& to) {
  for (const LayeredNumbers& said : numbers.layers)
    std::copy_if(said.curves.begin(), said.curves.end(), std::back_inserter(to), [](std::int32_t c) { return c >= 0; });
}

void add_curves(const TransformStack& stack, std::vector<std::int32_t>& to) {
  for (const ElementaryTransform& e : stack.elements) add_curves(e.numbers, to);
}

Quat rotation_of(const Vec3& degrees, RotationOrder order) {
  Quat out = Quat::Identity();
  for (const int axis : axes_of(order))
    if (degrees[axis] != 0) out = Quat(Eigen::AngleAxisd(degrees[axis] * k_degree, Vec3::Unit(axis))) * out;
  return out;
}

Vec3 angles_of(const Quat& rotation, RotationOrder order) {
  const auto [a, b, c] = axes_of(order);  // matrix = C * B * A
  const Mat3 m = rotation.normalized().toRotationMatrix();
  const double sign = (b - a + 3) % 3 == 1 ? 1 : -1;  // even orders
  const double sine = std::clamp(-sign * m(c, a), -1.0, 1.0);
  Vec3 out = Vec3::Zero();
  out[b] = std::asin(sine);
  if (std::abs(sine) < 1 - 1e-12) {
    out[a] = std::atan2(sign * m(c, b), m(c, c));
    out[c] = std::atan2(sign * m(b, a), m(a, a));
  } else {
    out[c] = std::atan2(-sign * m(a, b), m(b, b));
  }
  return out / k_degree;
}

Vec3 numbers_at(const AnimatedNumbers& numbers, TransformKind kind, RotationOrder order, const ClipCurves& set,
                double time) {
  Vec3 out = numbers.rest;
  for (const LayeredNumbers& said : numbers.layers) {
    Vec3 value = said.fixed;
    for (std::size_t k = 0; k < 3; ++k)
      if (said.curves[k] >= 0)
        value[static_cast<Eigen::Index>(k)] = set.curves[static_cast<std::size_t>(said.curves[k])].at(time);
    const AnimationLayer& layer = set.layers[static_cast<std::size_t>(said.layer)];
    put_layer(layer, weight_at(layer, set, time), value, kind, order, out);
  }
  return out;
}

StackPose stack_pose(const TransformStack& stack, const ClipCurves& set, double time) {
  StackPose out;
  Mat3 linear = Mat3::Identity();
  Vec3 place = Vec3::Zero();
  for (const ElementaryTransform& e : stack.elements) {
    if (e.kind == TransformKind::k_matrix) {
      place += linear * e.matrix.topRightCorner<3, 1>();
      linear = linear * e.matrix.topLeftCorner<3, 3>();
      out.turn = out.turn * e.matrix.topLeftCorner<3, 3>();
      continue;
    }
    const Vec3 value = numbers_at(e.numbers, e.kind, e.order, set, time);
    if (e.kind == TransformKind::k_translate) {
      place += linear * ((e.inverted ? -e.unit : e.unit) * value);
    } else if (e.kind == TransformKind::k_scale) {
      linear = linear * value.asDiagonal();
      out.scale = out.scale.cwiseProduct(value);
    } else {
      Quat q = e.kind == TransformKind::k_rotate ? rotation_of(value, e.order)
                                                 : Quat(Eigen::AngleAxisd(value[0] * k_degree, e.axis.normalized()));
      if (e.inverted) q = q.conjugate();
      const Mat3 turn = q.toRotationMatrix();
      linear = linear * turn;
      out.turn = out.turn * turn;
    }
  }
  out.matrix.topLeftCorner<3, 3>() = linear;
  out.matrix.topRightCorner<3, 1>() = place;
  return out;
}

void shape_weights(std::span<const ShapeChannel::Shape> shapes, double percent, std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  // On its side of 0 a percentage lies between two neighbours, the nearer to 0 of which may be 0 itself.
  int from = -1, to = -1;
  const int count = static_cast<int>(shapes.size());
  const auto full = [&](int k) { return k < 0 ? 0.0 : shapes[static_cast<std::size_t>(k)].full; };
  const auto step = [&](int k) { from = to, to = k; };
  if (percent > 0) {
    for (int k = 0; k < count && (to < 0 || full(to) <= percent); ++k)
      if (full(k) > 0 && (to < 0 || full(k) > full(to))) step(k);
  } else {
    for (int k = count - 1; k >= 0 && (to < 0 || full(to) >= percent); --k)
      if (full(k) < 0 && (to < 0 || full(k) < full(to))) step(k);
  }
  if (to < 0)  // only shapes of the other side: the nearest one is taken backwards
    for (int k = 0; k < count; ++k)
      if (full(k) != 0 && (to < 0 || percent > 0)) to = k;
  const double span = full(to) - full(from);
  if (to < 0 || span == 0) return;
  const double t = (percent - full(from)) / span;
  if (from >= 0) out[static_cast<std::size_t>(from)] = 1 - t;
  out[static_cast<std::size_t>(to)] = t;
}

ScalePassing::ScalePassing(std::size_t node_count) : scale_(node_count, Vec3::Ones()), source_(node_count, -1) {}

void ScalePassing::set_scale(int node, const Vec3& scale) {
  scale_[static_cast<std::size_t>(node)] = scale.unaryExpr([](double s) { return at_least(s); });
}

Mat4 ScalePassing::local(int node, int parent, ScaleInheritance inheritance, const StackPose& pose) {
  const auto own = static_cast<std::size_t>(node);
  scale_[own] = pose.scale.unaryExpr([](double s) { return at_least(s); });
  Mat4 out = pose.matrix;
  if (scale_[own] != pose.scale && (pose.turn * pose.scale.asDiagonal()).isApprox(out.topLeftCorner<3, 3>(), 1e-12))
    out.topLeftCorner<3, 3>() = pose.turn * scale_[own].asDiagonal();
  if (inheritance == ScaleInheritance::k_product || parent < 0) return out;
  const auto above = static_cast<std::size_t>(parent);
  source_[own] = inheritance == ScaleInheritance::k_componentwise ? parent : source_[above];
  if (source_[own] >= 0) scale_[own] = scale_[own].cwiseProduct(scale_[static_cast<std::size_t>(source_[own])]);
  // The node stands in the parent's frame without its scale, at a place that is scaled; the product with the parent
  // takes that scale back.
  const Vec3 back = scale_[above].cwiseInverse();
  out.topLeftCorner<3, 3>() = back.asDiagonal() * pose.turn * scale_[own].asDiagonal();
  return out;
}

}  // namespace ft::inline io

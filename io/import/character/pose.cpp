#include "io/import/character/pose.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

Quat quaternion(const double* v) {
  Quat q(v[3], v[0], v[1], v[2]);
  const double length = q.norm();
  if (!(length > 1e-12)) return Quat::Identity();
  q.coeffs() /= length;
  return q;
}

void put(const Quat& q, std::span<double> out) {
  for (int k = 0; k < 4; ++k) out[static_cast<std::size_t>(k)] = q.coeffs()[k];
}

}  // namespace

Mat4 NodeTransform::matrix() const {
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix() * stretch;
  m.topRightCorner<3, 1>() = translation;
  return m;
}

NodeTransform decompose(const Mat4& matrix) {
  NodeTransform out;
  out.translation = matrix.topRightCorner<3, 1>();
  const Mat3 linear = matrix.topLeftCorner<3, 3>();
  const double size = linear.cwiseAbs().maxCoeff();
  out.stretch = linear;
  if (!(size > 0) || !(std::abs((linear / size).determinant()) > 1e-15)) return out;
  // Newton's iteration to the nearest orthogonal matrix (Higham 1986); quadratic once near.
  Mat3 r = linear / size;
  for (int step = 0; step < 60; ++step) {
    const Mat3 next = 0.5 * (r + r.inverse().transpose());
    const double change = (next - r).cwiseAbs().maxCoeff();
    r = next;
    if (!(change > 1e-15)) break;
  }
  if (!r.allFinite()) return out;
  if (r.determinant() < 0) r = -r;  // reflections stay in the stretch
  out.rotation = Quat(r).normalized();
  out.stretch = out.rotation.toRotationMatrix().transpose() * linear;
  return out;
}

NodeTransform blend(const NodeTransform& a, const NodeTransform& b, double weight) {
  if (weight <= 0) return a;
  if (weight >= 1) return b;
  NodeTransform out;
  out.translation = a.translation + weight * (b.translation - a.translation);
  out.rotation = a.rotation.slerp(weight, b.rotation).normalized();
  out.stretch = a.stretch + weight * (b.stretch - a.stretch);
  return out;
}

void sample_track(const Track& track, double time, bool rotation, std::span<double> out) {
  const std::size_t width = static_cast<std::size_t>(track.width), stride = track.stride(), n = track.times.size();
  const bool cubic = track.interpolation == KeyInterpolation::k_cubic;
  const auto value = [&](std::size_t key) { return track.values.data() + key * stride + (cubic ? width : 0); };
  const auto copy = [&](std::size_t key) {
    if (rotation)
      put(quaternion(value(key)), out);
    else
      std::copy_n(value(key), width, out.begin());
  };
  const auto next =
      static_cast<std::size_t>(std::upper_bound(track.times.begin(), track.times.end(), time) - track.times.begin());
  if (next == 0) return copy(0);
  const std::size_t last = next - 1;
  if (next == n || track.interpolation == KeyInterpolation::k_step) return copy(last);

  const double span = track.times[next] - track.times[last];
  const double u = (time - track.times[last]) / span;
  const double *a = value(last), *b = value(next);
  if (!cubic) {
    if (rotation) return put(quaternion(a).slerp(u, quaternion(b)).normalized(), out);
    for (std::size_t k = 0; k < width; ++k) out[k] = a[k] + u * (b[k] - a[k]);
    return;
  }
  const double u2 = u * u, u3 = u2 * u;
  for (std::size_t k = 0; k < width; ++k) {
    const double out_tangent = a[width + k] * span, in_tangent = *(b + k - width) * span;
    out[k] = (2 * u3 - 3 * u2 + 1) * a[k] + (u3 - 2 * u2 + u) * out_tangent + (3 * u2 - 2 * u3) * b[k] +
             (u3 - u2) * in_tangent;
  }
  if (rotation) put(quaternion(out.data()), out);
}

NodeTransform sample_channel(const Channel& channel, const NodeTransform& rest, double time) {
  NodeTransform out = rest;
  std::array<double, 4> v{};
  if (!channel.translation.empty()) {
    sample_track(channel.translation, time, false, v);
    out.translation = Vec3(v[0], v[1], v[2]);
  }
  if (!channel.rotation.empty()) {
    sample_track(channel.rotation, time, true, v);
    out.rotation = Quat(v[3], v[0], v[1], v[2]);
  }
  if (!channel.scale.empty()) {
    sample_track(channel.scale, time, false, v);
    out.stretch = Vec3(v[0], v[1], v[2]).asDiagonal();
  }
  return out;
}

ClipPose::ClipPose(const Character& character, const Clip* clip) {
  morph_start_.push_back(0);
  for (const CharacterNode& node : character.nodes) {
    rest_.push_back(node.local);
    rest_morphs_.insert(rest_morphs_.end(), node.morph_weights.begin(), node.morph_weights.end());
    morph_start_.push_back(static_cast<int>(rest_morphs_.size()));
    parents_.push_back(node.parent);
  }
  if (clip == nullptr) return;
  stacks_ = clip->stacks, shapes_ = clip->shapes, curves_ = clip->curves;
  std::sort(stacks_.begin(), stacks_.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  std::vector<char> stacked(rest_.size(), 0);
  for (const TransformStack& stack : stacks_) stacked[static_cast<std::size_t>(stack.node)] = 1;
  for (const Channel& channel : clip->channels) {
    const auto node = static_cast<std::size_t>(channel.node);
    moving_.push_back({channel, decompose(rest_[node]), stacked[node] != 0});
  }
}

void ClipPose::sample_stacks(double time, std::span<Mat4> locals) const {
  ScalePassing passing(rest_.size());
  std::vector<char> given(rest_.size(), 0);
  for (const TransformStack& stack : stacks_) {
    const auto node = static_cast<std::size_t>(stack.node);
    const int parent = parents_[node];
    if (stack.inheritance != ScaleInheritance::k_product && parent >= 0 && !given[static_cast<std::size_t>(parent)])
      passing.set_scale(parent, locals[static_cast<std::size_t>(parent)].topLeftCorner<3, 3>().colwise().norm());
    locals[node] = passing.local(stack.node, parent, stack.inheritance, stack_pose(stack, curves_, time));
    given[node] = 1;
  }
}

void ClipPose::sample(double time, std::span<Mat4> locals, std::span<double> morphs) const {
  std::copy(rest_.begin(), rest_.end(), locals.begin());
  std::copy(rest_morphs_.begin(), rest_morphs_.end(), morphs.begin());
  std::vector<double> weights;
  if (!stacks_.empty()) sample_stacks(time, locals);
  for (const ShapeChannel& channel : shapes_) {
    const Vec3 percent = numbers_at(channel.percent, TransformKind::k_translate, RotationOrder::k_xyz, curves_, time);
    weights.resize(channel.shapes.size());
    shape_weights(channel.shapes, percent[0], weights);
    const auto begin = static_cast<std::size_t>(morph_start_[static_cast<std::size_t>(channel.node)]);
    for (std::size_t k = 0; k < weights.size(); ++k)
      morphs[begin + static_cast<std::size_t>(channel.shapes[k].morph)] = weights[k];
  }
  for (const Moving& moving : moving_) {
    const Channel& c = moving.channel;
    const auto node = static_cast<std::size_t>(c.node);
    if (!c.translation.empty() || !c.rotation.empty() || !c.scale.empty())
      locals[node] = sample_channel(c, moving.over_stack ? decompose(locals[node]) : moving.rest, time).matrix();
    if (!c.weights.empty()) {
      weights.resize(static_cast<std::size_t>(c.weights.width));
      sample_track(c.weights, time, false, weights);
      const auto begin = static_cast<std::size_t>(morph_start_[node]),
                 end = static_cast<std::size_t>(morph_start_[node + 1]);
      for (std::size_t k = 0; k < weights.size() && begin + k < end; ++k) morphs[begin + k] = weights[k];
    }
  }
}

void globals_from_locals(std::span<const CharacterNode> nodes, std::span<const Mat4> locals, std::span<Mat4> globals) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent < 0)
      globals[i] = locals[i];
    else
      globals[i].noalias() = globals[static_cast<std::size_t>(nodes[i].parent)] * locals[i];
  }
}

std::vector<Mat4> rest_globals(std::span<const CharacterNode> nodes) {
  std::vector<Mat4> locals, globals(nodes.size());
  for (const CharacterNode& node : nodes) locals.push_back(node.local);
  globals_from_locals(nodes, locals, globals);
  return globals;
}

}  // namespace ft::inline io

#include "io/import/character/plain_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/import/character/motion_change.h"
#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

constexpr double k_off = 2e-7;                 // of what lies between two keys [rad, of a length]
constexpr double k_least_step = 1.0 / 15360;   // s, between keys that straight lines join
constexpr double k_least_spline = 1.0 / 1920;  // s, between keys that cubic splines join
constexpr double k_difference = 0.01;          // of the time between two keys: over which a slope is measured
constexpr double k_instant = 2e-6;             // s: nearer keys are a step
constexpr double k_most_shear = 1e-4;          // of the scale, that nobody sees

/// Translation, rotation x y z w and scale of a node.
using Numbers = Eigen::Matrix<double, 10, 1>;

/// The time of 32 bits in the middle of two; the first of them where none lies between.
double middle_of(double from, double to) {
  const double middle = round_to_float(0.5 * (from + to));
  return middle > from && middle < to ? middle : from;
}

/// What a node's matrix relative to its parent depends on: its channel, its stack, the stacks whose scale it takes.
Clip part_for(const Character& character, const Clip& clip, int node) {
  Clip out;
  if (const Channel* channel = find_channel(clip, node)) out.channels.push_back(*channel);
  std::vector<std::int32_t> used;
  for (int n = node; n >= 0; n = character.nodes[at(n)].parent) {
    const TransformStack* stack = find_stack(clip, n);
    if (stack == nullptr) break;
    out.stacks.push_back(*stack), add_curves(*stack, used);
    if (stack->inheritance == ScaleInheritance::k_product) break;
  }
  out.curves.layers = clip.curves.layers;
  for (const AnimationLayer& layer : clip.curves.layers)
    if (layer.weight_curve >= 0) used.push_back(layer.weight_curve);
  out.curves.curves.resize(clip.curves.curves.size());
  for (const std::int32_t c : used) out.curves.curves[at(c)] = clip.curves.curves[at(c)];
  return out;
}

class Plainer {
 public:
  Plainer(const Character& character, const Clip& clip, int node)
      : node_(node),
        part_(part_for(character, clip, node)),
        pose_(character, &part_),
        locals_(character.nodes.size()),
        morphs_(pose_.rest_morphs().size()) {}

  NodeTransform at_time(double time) {
    pose_.sample(time, locals_, morphs_);
    return decompose(locals_[at(node_)]);
  }
  /// The quaternion of two that is nearer to the one given.
  Numbers numbers(double time, const Numbers* near) {
    const NodeTransform t = at_time(time);
    Numbers out;
    out << t.translation, t.rotation.coeffs(), t.stretch.diagonal();
    const Mat3 beside = t.stretch - Mat3(t.stretch.diagonal().asDiagonal());
    shear_ = std::max(shear_, beside.cwiseAbs().maxCoeff() / std::max(1e-12, t.stretch.cwiseAbs().maxCoeff()));
    if (near != nullptr && near->segment<4>(3).dot(out.segment<4>(3)) < 0) out.segment<4>(3) *= -1;
    return out;
  }

  /// Largest so far, of the largest scale.
  double shear() const { return shear_; }

  /// Adds the times between two keys that need one where straight lines join them.
  void split(double from, const NodeTransform& a, double to, const NodeTransform& b, std::vector<double>& times) {
    if (to - from < 2 * k_least_step) return;
    bool straight = true;
    for (const double w : {0.25, 0.5, 0.75}) {
      const NodeTransform now = at_time(from + w * (to - from)), line = blend(a, b, w);
      const double size = std::max({now.translation.norm(), a.translation.norm(), b.translation.norm()});
      straight = straight && (now.translation - line.translation).norm() <= k_off * size &&
                 now.rotation.angularDistance(line.rotation) <= k_off &&
                 (now.stretch - line.stretch).cwiseAbs().maxCoeff() <= k_off * now.stretch.cwiseAbs().maxCoeff();
    }
    if (straight) return;
    const double middle = middle_of(from, to);
    if (middle == from) return;
    const NodeTransform m = at_time(middle);
    split(from, a, middle, m, times);
    times.push_back(middle);
    split(middle, m, to, b, times);
  }

  /// A cubic between two times with its values and slopes [1/s] at both.
  struct Segment {
    double from, to;
    Numbers a, b, out_of_a, into_b;
    Numbers at_share(double u) const {
      const double u2 = u * u, u3 = u2 * u, span = to - from;
      return (2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * span * out_of_a + (3 * u2 - 2 * u3) * b +
             (u3 - u2) * span * into_b;
    }
  };
  Segment segment(double from, double to, const Numbers& a) {
    Segment out{from, to, a, numbers(to, &a), {}, {}};
    const double span = to - from, d = k_difference * span;
    if (span < k_instant || middle_of(from, to) == from) {
      out.out_of_a = out.into_b = (out.b - a) / span;
      return out;
    }
    // One-sided differences of the second order: there may be a kink at a key.
    out.out_of_a = (-3 * a + 4 * numbers(from + d, &a) - numbers(from + 2 * d, &a)) / (2 * d);
    out.into_b = (3 * out.b - 4 * numbers(to - d, &out.b) + numbers(to - 2 * d, &out.b)) / (2 * d);
    return out;
  }
  /// Segments that follow the node from one time to another.
  void follow(double from, double to, const Numbers& a, std::vector<Segment>& segments) {
    const Segment whole = segment(from, to, a);
    bool follows = true;
    for (const double w : {0.25, 0.5, 0.75}) {
      const Numbers now = numbers(from + w * (to - from), &a), there = whole.at_share(w);
      const double size = std::max(now.head<3>().norm(), a.head<3>().norm());
      follows = follows && (now - there).head<3>().norm() <= k_off * size &&
                2 * (now.segment<4>(3) - there.segment<4>(3).normalized()).norm() <= k_off &&
                (now - there).tail<3>().cwiseAbs().maxCoeff() <= k_off * now.tail<3>().cwiseAbs().maxCoeff();
    }
    const double middle = middle_of(from, to);
    if (follows || to - from < 2 * k_least_spline || middle == from) return segments.push_back(whole);
    follow(from, middle, a, segments);
    const Numbers m = segments.back().b;
    follow(middle, to, m, segments);
  }

 private:
  int node_;
  Clip part_;
  double shear_ = 0;
  ClipPose pose_;
  std::vector<Mat4> locals_;
  std::vector<double> morphs_;
};

/// Times [s] at which the curves that move a node have keys, and the clip's ends; ascending.
std::vector<double> stack_keys(const Character& character, const Clip& clip, int node) {
  std::vector<double> keys{clip.start, clip.end};
  // What a node inherits may move it, too.
  for (int n = node; n >= 0; n = character.nodes[at(n)].parent) {
    const std::vector<double> own = key_times(clip, n);
    keys.insert(keys.end(), own.begin(), own.end());
    const TransformStack* above = find_stack(clip, n);
    if (above == nullptr || above->inheritance == ScaleInheritance::k_product) break;
  }
  for (double& time : keys) time = round_to_float(time);
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

/// (in-slope, value, out-slope) of a key, for each part of the node.
void append(double time, const Numbers& in, const Numbers& value, const Numbers& out, Channel& to) {
  const auto part = [&](Track& track, Eigen::Index first, Eigen::Index width) {
    track.times.push_back(time);
    for (const Numbers* v : {&in, &value, &out})
      track.values.insert(track.values.end(), v->data() + first, v->data() + first + width);
  };
  part(to.translation, 0, 3), part(to.rotation, 3, 4), part(to.scale, 7, 3);
}

}  // namespace

std::vector<double> straight_times(const Character& character, const Clip& clip, int node) {
  const std::vector<double> keys = stack_keys(character, clip, node);
  Plainer plainer(character, clip, node);
  std::vector<double> times{keys.front()};
  for (std::size_t k = 1; k < keys.size(); ++k) {
    plainer.split(keys[k - 1], plainer.at_time(keys[k - 1]), keys[k], plainer.at_time(keys[k]), times);
    times.push_back(keys[k]);
  }
  return times;
}

Clip plain_clip(const Character& character, const Clip& clip, std::vector<std::string>& notes) {
  Clip out = clip;
  if (clip.stacks.empty()) return out;
  out.stacks.clear();
  std::vector<Channel> added;
  for (const TransformStack& stack : clip.stacks) {
    const int node = stack.node;
    const std::vector<double> keys = stack_keys(character, clip, node);
    Plainer plainer(character, clip, node);
    Numbers a = plainer.numbers(keys.front(), nullptr);
    std::vector<Plainer::Segment> segments;
    for (std::size_t k = 1; k < keys.size(); ++k) {
      plainer.follow(keys[k - 1], keys[k], a, segments);
      a = segments.back().b;
    }
    Channel channel;
    channel.node = node;
    channel.translation.width = channel.scale.width = 3;
    channel.rotation.width = 4;
    for (Track* track : {&channel.translation, &channel.rotation, &channel.scale})
      track->interpolation = KeyInterpolation::k_cubic;
    const Numbers none = Numbers::Zero();
    for (std::size_t k = 0; k <= segments.size(); ++k)
      append(k < segments.size() ? segments[k].from : keys.back(), k > 0 ? segments[k - 1].into_b : none,
             k < segments.size() ? segments[k].a : a, k < segments.size() ? segments[k].out_of_a : none, channel);
    if (plainer.shear() > k_most_shear)
      notes.push_back(fmt::format("glTF cannot hold the shear of \"{}\" (up to {:.2g} of its scale): it was left out",
                                  character.nodes[at(node)].name, plainer.shear()));
    added.push_back(std::move(channel));
  }
  // What a channel had over a stack is in the pose.
  std::erase_if(out.channels, [&](const Channel& c) { return find_stack(clip, c.node) != nullptr; });
  out.channels.insert(out.channels.end(), added.begin(), added.end());
  return out;
}

}  // namespace ft::inline io

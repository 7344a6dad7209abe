#include "io/import/character/plain_clip.h"

#include <algorithm>
#include <cmath>

#include "io/import/character/motion_change.h"
#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

constexpr double k_straight = 2e-7;
constexpr double k_least_step = 1.0 / 15360;  // s

class Plainer {
 public:
  Plainer(const Character& character, const Clip& clip)
      : pose_(character, &clip), locals_(character.nodes.size()), morphs_(pose_.rest_morphs().size()) {}

  NodeTransform at_time(int node, double time) {
    pose_.sample(time, locals_, morphs_);
    return decompose(locals_[at(node)]);
  }

  /// Adds the times between two keys that need one.
  void split(int node, double from, const NodeTransform& a, double to, const NodeTransform& b,
             std::vector<double>& times) {
    if (to - from < 2 * k_least_step) return;
    bool straight = true;
    for (const double w : {0.25, 0.5, 0.75}) {
      const NodeTransform now = at_time(node, from + w * (to - from)), line = blend(a, b, w);
      const double size = std::max({now.translation.norm(), a.translation.norm(), b.translation.norm()});
      straight = straight && (now.translation - line.translation).norm() <= k_straight * size &&
                 now.rotation.angularDistance(line.rotation) <= k_straight &&
                 (now.stretch - line.stretch).cwiseAbs().maxCoeff() <= k_straight * now.stretch.cwiseAbs().maxCoeff();
    }
    if (straight) return;
    const double middle = round_to_float(0.5 * (from + to));
    const NodeTransform m = at_time(node, middle);
    split(node, from, a, middle, m, times);
    times.push_back(middle);
    split(node, middle, m, to, b, times);
  }

 private:
  ClipPose pose_;
  std::vector<Mat4> locals_;
  std::vector<double> morphs_;
};

void append(const NodeTransform& t, double time, Channel& to) {
  for (Track* track : {&to.translation, &to.rotation, &to.scale}) track->times.push_back(time);
  auto& turns = to.rotation.values;
  Eigen::Vector4d q = t.rotation.coeffs();
  if (turns.size() >= 4 && Eigen::Map<const Eigen::Vector4d>(turns.data() + turns.size() - 4).dot(q) < 0) q = -q;
  turns.insert(turns.end(), q.data(), q.data() + 4);
  for (int k = 0; k < 3; ++k) {
    to.translation.values.push_back(t.translation[k]);
    to.scale.values.push_back(t.stretch(k, k));
  }
}

}  // namespace

std::vector<double> straight_times(const Character& character, const Clip& clip, int node) {
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
  Plainer plainer(character, clip);
  std::vector<double> times{keys.front()};
  for (std::size_t k = 1; k < keys.size(); ++k) {
    plainer.split(node, keys[k - 1], plainer.at_time(node, keys[k - 1]), keys[k], plainer.at_time(node, keys[k]),
                  times);
    times.push_back(keys[k]);
  }
  return times;
}

Clip plain_clip(const Character& character, const Clip& clip) {
  Clip out = clip;
  if (clip.stacks.empty()) return out;
  out.stacks.clear();
  Plainer plainer(character, clip);
  for (const TransformStack& stack : clip.stacks) {
    const int node = stack.node;
    const std::vector<double> times = straight_times(character, clip, node);
    Channel channel;
    channel.node = node;
    channel.translation.width = channel.scale.width = 3;
    channel.rotation.width = 4;
    for (const double time : times) append(plainer.at_time(node, time), time, channel);
    const auto same = [&](const Channel& c) { return c.node == node; };
    std::erase_if(out.channels, same);  // what it had over the stack is in the pose
    out.channels.push_back(std::move(channel));
  }
  return out;
}

}  // namespace ft::inline io

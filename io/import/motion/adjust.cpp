#include "io/import/motion/adjust.h"

#include <algorithm>
#include <cmath>

#include "io/import/body/bind.h"
#include "io/import/character/plain_clip.h"
#include "io/import/motion/adjust_pose.h"

namespace ft::inline io {
namespace {

constexpr double k_straight = 2e-7;  // what a straight line between two keys may be off [m, rad]

bool is_below(const Character& character, int node, int ancestor) {
  while (node > ancestor) node = character.nodes[at(node)].parent;
  return node == ancestor;
}

Status check(const Character& character, int clip, const Mat4& placement, const MotionAdjustment& adjustment) {
  if (clip < 0 || at(clip) >= character.clips.size())
    return usage_error("clip " + std::to_string(clip) + " to be adjusted does not exist");
  if (!placement.allFinite() || !(adjustment.frame_time > 0) || !std::isfinite(adjustment.first_frame) ||
      adjustment.frame_count < 1)
    return usage_error("the frames or the place of the motion to be adjusted are no numbers above 0");
  const int count = static_cast<int>(character.nodes.size());
  const auto exists = [&](int node) { return node >= 0 && node < count; };
  if (adjustment.roots.empty() || !std::all_of(adjustment.roots.begin(), adjustment.roots.end(), exists))
    return usage_error("the root to be moved does not exist");
  std::vector<int> nodes = adjustment.roots;
  for (const AdjustedLimb& limb : adjustment.limbs) {
    const LimbChain& c = limb.chain;
    const auto carries = [&](int root) { return root != c.upper && is_below(character, c.upper, root); };
    if (!exists(c.upper) || !exists(c.lower) || !exists(c.end) || c.upper == c.lower || c.lower == c.end ||
        !is_below(character, c.lower, c.upper) || !is_below(character, c.end, c.lower) ||
        std::none_of(adjustment.roots.begin(), adjustment.roots.end(), carries))
      return usage_error("a planted limb is no chain of nodes below the root");
    nodes.insert(nodes.end(), {c.upper, c.lower, c.end});
  }
  std::sort(nodes.begin(), nodes.end());
  if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end())
    return usage_error("a node is moved twice: two planted limbs share it, or a root is named again");
  return {};
}

struct KeyTimes {
  std::vector<double> times;  ///< ascending
  std::vector<char> kept;     ///< 1: a key in any case; 0: a frame, a key where it is needed
};

/// All times at which something on the way from the scene to the nodes has a key, the clip's ends, and the frames
/// between.
KeyTimes all_key_times(const Character& character, const Clip& clip, const std::vector<int>& nodes,
                       const MotionAdjustment& adjustment) {
  const double step = adjustment.frame_time, first = adjustment.first_frame;
  const double end = std::max(clip.end, round_to_float(first + step * (adjustment.frame_count - 1)));
  std::vector<double> keys{clip.start, end};
  std::vector<char> seen(character.nodes.size(), 0);
  for (int node : nodes)
    for (; node >= 0 && !seen[at(node)]; node = character.nodes[at(node)].parent) {
      seen[at(node)] = 1;
      const std::vector<double> own = key_times(clip, node);
      keys.insert(keys.end(), own.begin(), own.end());
    }
  for (const int node : nodes)  // what is moved becomes straight lines
    if (find_stack(clip, node) != nullptr) {
      const std::vector<double> own = straight_times(character, clip, node);
      keys.insert(keys.end(), own.begin(), own.end());
    }
  std::sort(keys.begin(), keys.end());
  const auto one_float = [](double a, double b) { return static_cast<float>(a) == static_cast<float>(b); };
  keys.erase(std::unique(keys.begin(), keys.end(), one_float), keys.end());

  KeyTimes out;
  double frame = std::ceil((keys.front() - first) / step);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    out.times.push_back(keys[k]), out.kept.push_back(1);
    if (k + 1 == keys.size()) break;
    for (double time; (time = first + frame * step) < keys[k + 1] - 0.01 * step; ++frame)  // not two keys at one frame
      if (time > keys[k] + 0.01 * step) out.times.push_back(round_to_float(time)), out.kept.push_back(0);
  }
  return out;
}

/// A moved part of a node at a time: x y z, or x y z w.
std::vector<double> numbers(const NodeTransform& t, ChannelPath path) {
  if (path == ChannelPath::k_translation) return {t.translation.x(), t.translation.y(), t.translation.z()};
  return {t.rotation.x(), t.rotation.y(), t.rotation.z(), t.rotation.w()};
}

bool is_moved(const AdjustedNode& node, ChannelPath path) {
  const auto a = numbers(node.source, path), b = numbers(node.now, path);
  return !std::equal(a.begin(), a.end(), b.begin(),
                     [](double x, double y) { return static_cast<float>(x) == static_cast<float>(y); });
}

double off_the_line(const AdjustedNode& a, const AdjustedNode& b, const AdjustedNode& between, double weight,
                    ChannelPath path) {
  if (path == ChannelPath::k_rotation)
    return a.now.rotation.slerp(weight, b.now.rotation).angularDistance(between.now.rotation);
  return between.scale *
         (a.now.translation + weight * (b.now.translation - a.now.translation) - between.now.translation).norm();
}

/// Which of the times get a key in one channel.
std::vector<char> needed_keys(const KeyTimes& keys, const std::vector<AdjustedPose>& poses, std::size_t node,
                              ChannelPath path) {
  std::vector<char> needed = keys.kept;
  for (std::size_t a = 0, b; a + 1 < keys.times.size(); a = b) {
    for (b = a + 1; !keys.kept[b];) ++b;
    bool straight = true;
    for (std::size_t k = a + 1; k < b && straight; ++k)
      straight = off_the_line(poses[a].nodes[node], poses[b].nodes[node], poses[k].nodes[node],
                              (keys.times[k] - keys.times[a]) / (keys.times[b] - keys.times[a]), path) <= k_straight;
    if (!straight)
      std::fill(needed.begin() + static_cast<std::ptrdiff_t>(a), needed.begin() + static_cast<std::ptrdiff_t>(b), 1);
  }
  return needed;
}

Track new_track(const KeyTimes& keys, const std::vector<AdjustedPose>& poses, std::size_t node, ChannelPath path,
                const Track* source) {
  const std::vector<char> needed = needed_keys(keys, poses, node, path);
  Track out;
  out.width = path == ChannelPath::k_rotation ? 4 : 3;
  const auto width = static_cast<std::size_t>(out.width);
  for (std::size_t k = 0; k < keys.times.size(); ++k) {
    if (!needed[k]) continue;
    const AdjustedNode& now = poses[k].nodes[node];
    std::vector<double> value = numbers(now.now, path);
    const bool has_keys = source != nullptr && !source->empty() && source->interpolation != KeyInterpolation::k_cubic;
    if (has_keys && !is_moved(now, path)) {
      const auto same = std::find_if(source->times.begin(), source->times.end(), [&](double time) {
        return static_cast<float>(time) == static_cast<float>(keys.times[k]);
      });
      if (same != source->times.end())
        std::copy_n(source->values.begin() + (same - source->times.begin()) * out.width, width, value.begin());
    } else if (path == ChannelPath::k_rotation && out.values.size() >= width) {
      double along = 0;
      for (std::size_t i = 0; i < width; ++i) along += value[i] * out.values[out.values.size() - width + i];
      if (along < 0)
        for (double& v : value) v = -v;
    }
    out.times.push_back(keys.times[k]);
    for (const double v : value) out.values.push_back(round_to_float(v));
  }
  return out;
}

}  // namespace

std::vector<int> motion_roots(const Character& character, int clip, const std::vector<int>& meshes) {
  std::vector<int> chosen = meshes;
  if (chosen.empty())
    for (std::size_t m = 0; m < character.meshes.size(); ++m) chosen.push_back(static_cast<int>(m));
  int top = find_pelvis(character, chosen);
  if (clip < 0 || at(clip) >= character.clips.size() || character.nodes.empty()) return {top};
  const Clip& moved_by = character.clips[at(clip)];
  for (int node = top; node >= 0; node = character.nodes[at(node)].parent)
    if (varies(moved_by, node)) top = node;
  if (top > 0 || character.nodes[0].local != Mat4::Identity() || clip_moves(moved_by, 0)) return {top};
  // Above several roots the importer puts a node that the file does not have: those below it that carry something.
  std::vector<int> out;
  for (int i = 1; i < static_cast<int>(character.nodes.size()); ++i) {
    if (character.nodes[at(i)].parent > 0) continue;
    const bool carries = std::any_of(chosen.begin(), chosen.end(), [&](int m) {
      const CharacterMesh& mesh = character.meshes[at(m)];
      const auto bone_below = [&](const SkinBone& bone) { return is_below(character, bone.node, i); };
      return mesh.bones.empty() ? is_below(character, mesh.node, i)
                                : std::any_of(mesh.bones.begin(), mesh.bones.end(), bone_below);
    });
    if (carries) out.push_back(i);
  }
  return out.size() > 1 ? out : std::vector<int>{top};
}

Result<AdjustedMotion> adjust_motion(const Character& character, int clip_index, const Mat4& placement,
                                     const MotionAdjustment& adjustment) {
  if (Status s = check(character, clip_index, placement, adjustment); !s) return s.error();
  const Clip& clip = character.clips[at(clip_index)];
  const PoseAdjuster adjuster(character, clip, placement, adjustment);
  const KeyTimes keys = all_key_times(character, clip, adjuster.nodes(), adjustment);
  AdjustedMotion out;
  std::vector<AdjustedPose> poses;
  for (const double time : keys.times) {
    auto pose = adjuster.solve(time);
    if (!pose) return pose.error();
    out.root_rest = std::max(out.root_rest, pose->root_rest);
    out.worst_miss = std::max(out.worst_miss, pose->miss);
    poses.push_back(std::move(*pose));
  }
  for (std::size_t n = 0; n < adjuster.nodes().size(); ++n)
    for (const ChannelPath path : {ChannelPath::k_translation, ChannelPath::k_rotation}) {
      const auto moved = [&](const AdjustedPose& pose) { return is_moved(pose.nodes[n], path); };
      if (std::none_of(poses.begin(), poses.end(), moved)) continue;
      const int node = adjuster.nodes()[n];
      const Channel* channel = find_channel(clip, node);
      const Track* source = channel != nullptr ? &track_of(*channel, path) : nullptr;
      out.channels.push_back({node, path, new_track(keys, poses, n, path, source)});
    }
  return out;
}

}  // namespace ft::inline io

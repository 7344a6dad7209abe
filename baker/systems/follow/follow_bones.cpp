#include "baker/systems/follow/follow_bones.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/import/character/plain_clip.h"
#include "io/import/character/pose.h"
#include "io/shot/patterns.h"
#include "solvers/follow/damped_oscillator.h"

namespace ft::inline baker {
namespace {

constexpr double k_step = 1.0 / 480;  ///< longest over which a target is taken to keep its velocity [s]

/// Where a joint points: its end, in its own space and in file units. Of a joint with children their middle; else the
/// middle of the skin that it carries; else as far on as it is from its parent.
Vec3 tip_of(const PlacedCharacter& placed, int joint) {
  const Character& character = placed.character;
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t n = 0; n < character.nodes.size(); ++n)
    if (character.nodes[n].parent == joint) sum += placed.bind.locals[n].topRightCorner<3, 1>(), ++count;
  if (count > 0 && sum.norm() > 0) return sum / count;
  Vec3 skin = Vec3::Zero();
  double weight = 0;
  for (std::size_t v = 0; v < placed.skin.base.size(); ++v)
    for (int row = placed.skin.start[v]; row < placed.skin.start[v + 1]; ++row) {
      const Skin::Binding& binding = placed.skin.bindings[at(placed.skin.binding[at(row)])];
      if (binding.node != joint) continue;
      const double w = placed.skin.weight[at(row)];
      skin += w * (binding.inverse_bind * placed.skin.base[v].homogeneous()).head<3>();
      weight += w;
    }
  if (weight > 0 && skin.norm() > 0) return skin / weight;
  const Mat3 turned = placed.bind.locals[at(joint)].topLeftCorner<3, 3>();
  return turned.transpose() * placed.bind.locals[at(joint)].topRightCorner<3, 1>();
}

struct Follower {
  int joint = -1;
  Vec3 tip = Vec3::Zero();
  DampedOscillator::Lag lag{};
  Vec3 target = Vec3::Zero(), velocity = Vec3::Zero();
  bool started = false;
  double turned = 0;                 ///< now [rad]
  double behind = 0;                 ///< of the tip, now, from its animated place [m]
  std::vector<Quat> rotations{};     ///< local, of each frame of the shot
  Quat rotation = Quat::Identity();  ///< local, now
};

class BoneFollower {
 public:
  BoneFollower(const PlacedCharacter& placed, const Eigen::Isometry3d& place, std::span<const int> joints,
               const FollowSpec& spec)
      : placed_(placed),
        world_(place.matrix() * placed.placement),
        spec_(spec),
        pose_(placed.character, &placed.character.clips[at(placed.clip)]),
        locals_(placed.character.nodes.size()),
        globals_(placed.character.nodes.size()),
        morphs_(at(pose_.morph_start().back())) {
    spring_.omega = 2 * std::numbers::pi * spec.frequency;
    spring_.zeta = spec.damping_ratio;
    for (const int joint : joints) followers_.push_back({joint, tip_of(placed, joint)});
  }

  /// The shot's time [s], dt after the last; carried: the primary jumps in between, and takes the lag along.
  void go_to(double time, double dt, const Teleport* carried) {
    pose_.sample(placed_.playback.start + placed_.playback.speed * time, locals_, morphs_);
    std::size_t next = 0;
    for (std::size_t n = 0; n < globals_.size(); ++n) {
      const int parent = placed_.character.nodes[n].parent;
      const Mat4 above = parent < 0 ? world_ : globals_[at(parent)];
      globals_[n] = above * locals_[n];
      if (next < followers_.size() && followers_[next].joint == static_cast<int>(n))
        advance(followers_[next++], above, dt, carried);
    }
  }

  void record(FollowedBones& out) {
    double lag = 0, turn = 0;
    for (Follower& f : followers_) {
      f.rotations.push_back(f.rotation);
      lag = std::max(lag, f.behind);
      turn = std::max(turn, f.turned);
    }
    out.lag.push_back(lag);
    out.turn.push_back(turn);
  }

  std::span<const Follower> followers() const { return followers_; }

 private:
  void advance(Follower& f, const Mat4& above, double dt, const Teleport* carried) {
    Mat4& own = globals_[at(f.joint)];
    const Vec3 origin = own.topRightCorner<3, 1>(), target = (own * f.tip.homogeneous()).head<3>();
    if (carried) {
      f.lag.position = carried->motion.rotation() * f.lag.position;
      f.lag.velocity = carried->motion.rotation() * f.lag.velocity;
      f.velocity = carried->motion.rotation() * f.velocity;
    } else if (f.started && dt > 0) {
      const Vec3 velocity = (target - f.target) / dt;
      DampedOscillator::turn(f.lag, velocity - f.velocity);
      spring_.advance(f.lag, dt);
      f.velocity = velocity;
    }
    f.target = target;
    f.started = true;
    const Vec3 from = target - origin, to = from + spec_.amount * f.lag.position;
    Eigen::AngleAxisd turn(0, Vec3::UnitX());
    if (from.norm() > 0 && to.norm() > 1e-6 * from.norm()) turn = Quat::FromTwoVectors(from, to);
    turn.angle() = std::min(turn.angle(), spec_.max_angle * std::numbers::pi / 180);
    f.turned = turn.angle();
    f.behind = (turn * from - from).norm();
    // The turn in the world is one before the joint's own rotation, in the space of its parent.
    const NodeTransform local = decompose(locals_[at(f.joint)]);
    const Quat parent = decompose(above).rotation;
    f.rotation = (parent.conjugate() * Quat(turn) * parent * local.rotation).normalized();
    NodeTransform turned = local;
    turned.rotation = f.rotation;
    own = above * turned.matrix();
  }

  const PlacedCharacter& placed_;
  Mat4 world_;
  const FollowSpec& spec_;
  DampedOscillator spring_;
  ClipPose pose_;
  std::vector<Mat4> locals_, globals_;
  std::vector<double> morphs_;
  std::vector<Follower> followers_;
};

/// Rotations of a joint against its parent, as the clip has them at times [s of the clip].
std::vector<Quat> rotations_at(const PlacedCharacter& placed, int joint, std::span<const double> times) {
  const ClipPose pose(placed.character, &placed.character.clips[at(placed.clip)]);
  std::vector<Mat4> locals(placed.character.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  std::vector<Quat> out;
  for (const double time : times) {
    pose.sample(time, locals, morphs);
    out.push_back(decompose(locals[at(joint)]).rotation);
  }
  return out;
}

/// The joint's keys outside of the shot stay, and within it there is one for each frame.
ChangedChannel channel_of(const PlacedCharacter& placed, const Follower& f, const FollowTiming& timing) {
  ChangedChannel out{f.joint, ChannelPath::k_rotation, {}};
  out.track.width = 4;
  const Playback& playback = placed.playback;
  const auto time_of = [&](std::size_t frame) {
    return round_to_float(playback.start + playback.speed * static_cast<double>(frame) / timing.fps);
  };
  const auto append = [&](double time, Quat q) {
    const auto& v = out.track.values;
    if (v.size() >= 4 &&
        Eigen::Vector4d(v[v.size() - 4], v[v.size() - 3], v[v.size() - 2], v.back()).dot(q.coeffs()) < 0)
      q.coeffs() = -q.coeffs();
    out.track.times.push_back(time);
    for (int k = 0; k < 4; ++k) out.track.values.push_back(round_to_float(q.coeffs()[k]));
  };
  const Clip& clip = placed.character.clips[at(placed.clip)];
  const Channel* channel = find_channel(clip, f.joint);
  std::vector<double> stack_keys;
  if (find_stack(clip, f.joint) != nullptr) stack_keys = straight_times(placed.character, clip, f.joint);
  const std::vector<Quat> stack_rotations = rotations_at(placed, f.joint, stack_keys);
  const NodeTransform rest = decompose(placed.character.nodes[at(f.joint)].local);
  const double begin = time_of(0), end = time_of(f.rotations.size() - 1);
  const auto keep = [&](auto&& wanted) {
    for (std::size_t k = 0; k < stack_keys.size(); ++k)
      if (wanted(stack_keys[k])) append(stack_keys[k], stack_rotations[k]);
    if (!channel || !stack_keys.empty()) return;
    for (const double time : channel->rotation.times)
      if (wanted(round_to_float(time))) append(round_to_float(time), sample_channel(*channel, rest, time).rotation);
  };
  keep([&](double time) { return time < begin; });
  for (std::size_t frame = 0; frame < f.rotations.size(); ++frame) append(time_of(frame), f.rotations[frame]);
  keep([&](double time) { return time > end; });
  return out;
}

}  // namespace

int FollowTiming::steps(double longest) const {
  return std::max(1, static_cast<int>(std::ceil(1 / (fps * longest) - 1e-9)));
}

Result<std::vector<int>> joints_like(const std::vector<std::string>& patterns, const Character& character) {
  std::vector<std::string> names;
  for (const CharacterNode& node : character.nodes) names.push_back(node.name);
  return indices_like(patterns, names, "bones", "joint");
}

FollowedBones follow_bones(const PlacedCharacter& placed, const Eigen::Isometry3d& place, std::span<const int> joints,
                           const FollowSpec& spec, const FollowTiming& timing, std::span<const Teleport> teleports) {
  FollowedBones out;
  BoneFollower bones(placed, place, joints, spec);
  const int steps = timing.steps(k_step), lead = timing.preroll_frames;
  const double dt = 1 / (timing.fps * steps);
  bones.go_to(-lead / timing.fps, 0, nullptr);
  if (lead == 0) bones.record(out);
  for (int frame = 1 - lead; frame < timing.frame_count; ++frame) {
    if (const Teleport* jump = teleport_into(teleports, timing.first_frame + frame)) {
      bones.go_to(frame / timing.fps, 1 / timing.fps, jump);
    } else {
      for (int k = 1; k <= steps; ++k) bones.go_to((frame - 1) / timing.fps + k * dt, dt, nullptr);
    }
    if (frame >= 0) bones.record(out);
  }
  for (const Follower& f : bones.followers()) out.channels.push_back(channel_of(placed, f, timing));
  return out;
}

}  // namespace ft::inline baker

#include "io/import/motion/adjust_pose.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

Vec3 place(const Mat4& m) {
  return m.topRightCorner<3, 1>();
}
Quat rotation(const Mat4& m) {
  return decompose(m).rotation;
}

/// A turn of the world as it is seen in the space of a node that is turned by `frame`.
Quat in_frame(const Quat& turn, const Quat& frame) {
  return frame.conjugate() * turn * frame;
}

/// Two limbs that pull at the root in different directions settle in some ten rounds, if there is a place for both.
constexpr int k_reach_rounds = 100;
constexpr double k_reach_tolerance = 1e-9;  // m

}  // namespace

PoseAdjuster::PoseAdjuster(const Character& character, const Clip& clip, const Mat4& placement,
                           const MotionAdjustment& adjustment)
    : character_(character), clip_(clip), placement_(placement), adjustment_(adjustment), pose_(character, &clip) {
  nodes_ = adjustment.roots;
  for (const AdjustedLimb& limb : adjustment.limbs)
    nodes_.insert(nodes_.end(), {limb.chain.upper, limb.chain.lower, limb.chain.end});
  for (const int node : nodes_) {
    channels_.push_back(find_channel(clip, node));
    stacked_.push_back(find_stack(clip, node) != nullptr);
    rest_.push_back(decompose(character.nodes[at(node)].local));
  }
  find_axes();
}

void PoseAdjuster::globals(const std::vector<Mat4>& locals, std::vector<Mat4>& out) const {
  out.resize(locals.size());
  globals_from_locals(character_.nodes, locals, out);
}

TwoBonePose PoseAdjuster::places(const LimbChain& chain, std::span<const Mat4> all) const {
  const auto world = [&](int node) { return Vec3((placement_ * all[at(node)]).topRightCorner<3, 1>()); };
  return {world(chain.upper), world(chain.lower), world(chain.end)};
}

/// The mean over the clip, weighted by the bend; of a limb that is always straight, the axis about which it bends
/// towards where its end points (a foot), away from it.
void PoseAdjuster::find_axes() {
  constexpr int k_samples = 100;
  std::vector<Mat4> locals(character_.nodes.size()), all;
  std::vector<double> morphs(pose_.rest_morphs().size());
  axes_.assign(adjustment_.limbs.size(), Vec3::Zero());
  for (int sample = 0; sample <= k_samples; ++sample) {
    pose_.sample(clip_.start + clip_.duration() * sample / k_samples, locals, morphs);
    globals(locals, all);
    for (std::size_t l = 0; l < axes_.size(); ++l) {
      const LimbChain& chain = adjustment_.limbs[l].chain;
      const TwoBonePose p = places(chain, all);
      const Vec3 thigh = (p.lower - p.upper).normalized();
      Vec3 axis = thigh.cross((p.end - p.lower).normalized());
      if (const auto toe = std::find_if(character_.nodes.begin(), character_.nodes.end(),
                                        [&](const CharacterNode& n) { return n.parent == chain.end; });
          toe != character_.nodes.end()) {
        const Mat4 m = placement_ * all[static_cast<std::size_t>(toe - character_.nodes.begin())];
        axis += 1e-3 * (place(m) - p.end).normalized().cross(thigh);
      }
      if (axis.allFinite()) axes_[l] += rotation(placement_ * all[at(chain.upper)]).conjugate() * axis;
    }
  }
  for (Vec3& axis : axes_) axis.normalize();
}

Status PoseAdjuster::move_roots(const Eigen::Isometry3d& deviation, bool turns, std::span<const Mat4> all,
                                AdjustedPose& pose) const {
  for (std::size_t i = 0; i < adjustment_.roots.size(); ++i) {
    const int node = nodes_[i], parent = character_.nodes[at(node)].parent;
    const Mat4 space = parent < 0 ? placement_ : Mat4(placement_ * all[at(parent)]);
    const Mat4 in_parent = space.inverse() * deviation.matrix() * space;
    const std::string where = "node \"" + character_.nodes[at(node)].name + "\"";
    if (!in_parent.allFinite()) return input_error("cannot be moved: what is above it is flat or not finite", where);
    NodeTransform& now = pose.nodes[i].now;
    now.translation = in_parent.topLeftCorner<3, 3>() * now.translation + place(in_parent);
    if (!turns) continue;
    const Mat3 turn = in_parent.topLeftCorner<3, 3>();
    if ((turn.transpose() * turn - Mat3::Identity()).cwiseAbs().maxCoeff() > 1e-6)
      return input_error("cannot be turned: what is above it is scaled unequally", where);
    now.rotation = (Quat(turn) * now.rotation).normalized();
  }
  return {};
}

void PoseAdjuster::bend_limb(std::size_t limb, const Planted& planted, const Vec3& target, std::span<const Mat4> all,
                             AdjustedPose& pose) const {
  const AdjustedLimb& about = adjustment_.limbs[limb];
  const auto parent_rotation = [&](int node) {
    const int parent = character_.nodes[at(node)].parent;
    return rotation(parent < 0 ? placement_ : Mat4(placement_ * all[at(parent)]));
  };
  const Quat upper_frame = rotation(placement_ * all[at(about.chain.upper)]);
  const TwoBoneTurn turn = bend_to(places(about.chain, all), target, upper_frame * axes_[limb], about.limits);
  const Quat carried = rotation(placement_ * all[at(about.chain.end)]);
  const Quat wanted = carried.slerp(planted.target.weight, planted.imported_rotation);
  const Quat end_turn = (turn.upper * turn.lower).conjugate() * wanted * carried.conjugate();

  AdjustedNode* nodes = &pose.nodes[adjustment_.roots.size() + 3 * limb];
  const auto apply = [&](AdjustedNode& node, const Quat& world_turn, int index) {
    node.now.rotation = (in_frame(world_turn, parent_rotation(index)) * node.now.rotation).normalized();
  };
  apply(nodes[0], turn.upper, about.chain.upper);
  apply(nodes[1], turn.lower, about.chain.lower);
  apply(nodes[2], end_turn, about.chain.end);
}

Result<AdjustedPose> PoseAdjuster::solve(double time) const {
  std::vector<Mat4> locals(character_.nodes.size()), all;
  std::vector<double> morphs(pose_.rest_morphs().size());
  pose_.sample(time, locals, morphs);
  globals(locals, all);
  AdjustedPose out;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int parent = character_.nodes[at(nodes_[i])].parent;
    AdjustedNode node;
    node.source = stacked_[i]               ? decompose(locals[at(nodes_[i])])
                  : channels_[i] != nullptr ? sample_channel(*channels_[i], rest_[i], time)
                                            : rest_[i];
    node.now = node.source;
    node.scale = (parent < 0 ? placement_ : Mat4(placement_ * all[at(parent)])).topLeftCorner<3, 1>().norm();
    out.nodes.push_back(node);
  }

  const RootDeviation root = adjustment_.deviation ? adjustment_.deviation(time) : RootDeviation{};
  if (!root.displacement.allFinite() || !root.rotation.coeffs().allFinite() || !root.centre.allFinite())
    return usage_error("the deviation at " + std::to_string(time) + " s is not finite");
  const bool turns = root.rotation.vec() != Vec3::Zero(), moves = turns || root.displacement != Vec3::Zero();
  Eigen::Isometry3d deviation = Eigen::Isometry3d::Identity();
  if (turns) deviation.linear() = root.rotation.normalized().toRotationMatrix();
  deviation.translation() = root.displacement + root.centre - deviation.linear() * root.centre;

  const std::size_t limb_count = adjustment_.limbs.size();
  std::vector<Planted> planted(limb_count);
  std::vector<TwoBonePose> imported(limb_count);
  bool any_planted = false;
  for (std::size_t l = 0; l < limb_count; ++l) {
    const AdjustedLimb& limb = adjustment_.limbs[l];
    imported[l] = places(limb.chain, all);
    if (limb.target) planted[l].target = limb.target(time, imported[l].end);
    LimbTarget& target = planted[l].target;
    target.weight = std::clamp(target.weight, 0.0, 1.0);
    if (!target.place.allFinite()) return usage_error("a limb's place at " + std::to_string(time) + " s is not finite");
    planted[l].active = target.weight > 0 && (moves || (target.place - imported[l].end).norm() > k_reach_tolerance);
    planted[l].imported_rotation = rotation(placement_ * all[at(limb.chain.end)]);
    any_planted = any_planted || planted[l].active;
  }
  if (!moves && !any_planted) return out;

  const auto wanted = [&](std::size_t l, const Vec3& carried_end) {
    return Vec3(carried_end + planted[l].target.weight * (planted[l].target.place - carried_end));
  };
  // What a limb cannot reach, the root goes to meet.
  const Vec3 asked = deviation.translation();
  for (int round = 0; round < k_reach_rounds; ++round) {
    double most = 0;
    for (std::size_t l = 0; l < limb_count; ++l) {
      if (!planted[l].active) continue;
      const Reach reach = reach_of(imported[l], adjustment_.limbs[l].limits);
      const Vec3 way = wanted(l, deviation * imported[l].end) - deviation * imported[l].upper;
      const double r = way.norm(), beyond = r - std::clamp(r, reach.least, reach.most);
      if (!(r > 0) || std::abs(beyond) < k_reach_tolerance) continue;
      deviation.translation() += way / r * (beyond / planted[l].target.weight);
      most = std::max(most, std::abs(beyond));
    }
    if (most == 0) break;
  }
  out.root_rest = (deviation.translation() - asked).norm();

  if (Status s = move_roots(deviation, turns, all, out); !s) return s.error();
  if (!any_planted) return out;
  const auto refresh = [&] {
    for (std::size_t i = 0; i < nodes_.size(); ++i) locals[at(nodes_[i])] = out.nodes[i].now.matrix();
    globals(locals, all);
  };
  refresh();
  std::vector<Vec3> targets(limb_count);
  for (std::size_t l = 0; l < limb_count; ++l) {
    if (!planted[l].active) continue;
    targets[l] = wanted(l, places(adjustment_.limbs[l].chain, all).end);
    bend_limb(l, planted[l], targets[l], all, out);
  }
  refresh();
  for (std::size_t l = 0; l < limb_count; ++l)
    if (planted[l].active)
      out.miss = std::max(out.miss, (places(adjustment_.limbs[l].chain, all).end - targets[l]).norm());
  return out;
}

}  // namespace ft::inline io

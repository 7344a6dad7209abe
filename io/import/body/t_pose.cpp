#include "io/import/body/t_pose.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

Vec3 place(std::span<const Mat4> globals, int node) {
  return globals[at(node)].topRightCorner<3, 1>();
}

class TPoser {
 public:
  TPoser(const Character& character, const Figure& figure, const BindPose& from, const Mat3& axes)
      : character_(character), figure_(figure), pose_(from), axes_(axes), children_(character.nodes.size()) {
    for (std::size_t i = 0; i < children_.size(); ++i)
      if (const int parent = character.nodes[i].parent; parent >= 0)
        children_[at(parent)].push_back(static_cast<int>(i));
    reach_ = 0;
    for (std::size_t i = 0; i < children_.size(); ++i)
      if (character.nodes[i].parent >= 0)
        reach_ = std::max(reach_, bone(character.nodes[i].parent, static_cast<int>(i)).norm());
  }

  BindPose make(TPoseFrom kind) {
    const BindPose before = pose_;
    if (kind == TPoseFrom::k_any) stand_up();
    side_ = Vec3::UnitX();
    if (figure_.legs.size() == 2) side_ = level(joint(left().upper) - joint(right().upper));
    if (kind == TPoseFrom::k_any) straighten_trunk();
    for (const FigureLimb& arm : figure_.arms) set_arm(arm, kind);
    for (const FigureLimb& leg : figure_.legs) set_leg(leg, kind);
    for (std::size_t i = 0; i < children_.size(); ++i) {
      const int parent = character_.nodes[i].parent;
      if (pose_.globals[i] == before.globals[i] &&
          (parent < 0 || pose_.globals[at(parent)] == before.globals[at(parent)]))
        continue;
      pose_.locals[i] = parent < 0 ? pose_.globals[i] : Mat4(pose_.globals[at(parent)].inverse() * pose_.globals[i]);
    }
    return std::move(pose_);
  }

 private:
  Vec3 joint(int node) const { return axes_ * place(pose_.globals, node); }
  Vec3 bone(int from, int to) const { return joint(to) - joint(from); }
  static Vec3 level(Vec3 v) {
    v.y() = 0;
    return v.norm() > 1e-9 ? v.normalized() : Vec3::UnitX().eval();
  }
  const FigureLimb& left() const { return figure_.legs[figure_.legs[0].side == Side::k_right ? 1 : 0]; }
  const FigureLimb& right() const { return figure_.legs[figure_.legs[0].side == Side::k_right ? 0 : 1]; }

  /// Turns a node and all below it about the node; the turn is in Y-up axes.
  void turn(int node, const Mat3& rotation) {
    const Mat3 in_file = axes_.transpose() * rotation * axes_;
    const Vec3 pivot = place(pose_.globals, node);
    Mat4 move = Mat4::Identity();
    move.topLeftCorner<3, 3>() = in_file;
    move.topRightCorner<3, 1>() = pivot - in_file * pivot;
    std::vector<int> stack{node};
    while (!stack.empty()) {
      const int n = stack.back();
      stack.pop_back();
      pose_.globals[at(n)] = move * pose_.globals[at(n)];
      stack.insert(stack.end(), children_[at(n)].begin(), children_[at(n)].end());
    }
  }
  /// Turns a node the short way so that `from` becomes `to`. A half turn goes about the vertical, else about z.
  void aim(int node, const Vec3& from, const Vec3& to) {
    if (!(from.norm() > 1e-6 * reach_)) return;
    const Vec3 a = from.normalized(), b = to.normalized();
    if (a.dot(b) < -1 + 1e-9) {
      const Vec3 about = std::abs(a.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitZ();
      turn(node, Eigen::AngleAxisd(M_PI, about).toRotationMatrix());
      return;
    }
    turn(node, Quat::FromTwoVectors(a, b).toRotationMatrix());
  }

  /// Turns the whole figure: trunk up, left to +x, front to +z.
  void stand_up() {
    if (!figure_.has_trunk()) return;
    const Vec3 up = (axes_ * trunk_of(figure_, pose_.globals)).normalized();
    Vec3 side = joint(left().upper) - joint(right().upper);
    side = (side - side.dot(up) * up).normalized();
    if (figure_.legs[0].side == Side::k_none) {  // the toes tell the front
      Vec3 toes = Vec3::Zero();
      for (const FigureLimb& leg : figure_.legs)
        if (leg.end >= 0)
          for (const int toe : children_[at(leg.end)]) toes += bone(leg.end, toe);
      if (side.cross(up).dot(toes) < 0) side = -side, swapped_ = true;
    }
    if (!up.allFinite() || !side.allFinite()) return;
    Mat3 now;
    now << side, up, side.cross(up);
    turn(figure_.base, now.transpose());
  }

  /// Nodes from below `from` down to `to`, in that order.
  std::vector<int> path(int from, int to) const {
    std::vector<int> out;
    for (; to > from; to = character_.nodes[at(to)].parent) out.insert(out.begin(), to);
    return out;
  }

  void straighten_trunk() {
    if (swapped_) side_ = -side_;
    const int top = figure_.neck >= 0 ? figure_.neck : figure_.chest;
    if (top < 0 || !is_within(character_, top, figure_.base)) return;
    const std::vector<int> spine = path(figure_.base, top);
    for (std::size_t k = 0; k + 1 < spine.size(); ++k) aim(spine[k], bone(spine[k], spine[k + 1]), Vec3::UnitY());
    if (figure_.chest > figure_.base && figure_.arms.size() == 2) {
      Vec3 across = joint(figure_.arms[0].upper) - joint(figure_.arms[1].upper);
      if (sign_of(figure_.arms[0]) < 0) across = -across;
      aim(figure_.chest, level(across), side_);
    }
    for (int node = figure_.neck; node >= 0;) {  // to the top of the head, by its longest bone
      int next = -1;
      for (const int child : children_[at(node)])
        if (next < 0 || bone(node, child).norm() > bone(node, next).norm()) next = child;
      if (figure_.head > node && is_within(character_, figure_.head, node)) next = path(node, figure_.head).front();
      if (next < 0 || (figure_.head >= 0 && node > figure_.head)) break;
      aim(node, bone(node, next), Vec3::UnitY());
      node = next;
    }
  }

  /// 1 for the arm on the side that side_ points to.
  double sign_of(const FigureLimb& arm) const {
    if (arm.side != Side::k_none && figure_.legs.size() == 2 && figure_.legs[0].side != Side::k_none)
      return arm.side == Side::k_left ? 1 : -1;
    const Vec3 middle = 0.5 * (joint(figure_.arms[0].upper) + joint(figure_.arms[1].upper));
    return (joint(arm.upper) - middle).dot(side_) < 0 ? -1 : 1;
  }

  Vec3 to_children(int node) const {
    Vec3 out = Vec3::Zero();
    for (const int child : children_[at(node)]) out += bone(node, child);
    return out;
  }

  void set_arm(const FigureLimb& arm, TPoseFrom kind) {
    if (figure_.arms.size() != 2) return;
    const Vec3 out = sign_of(arm) * side_;
    if (kind == TPoseFrom::k_any && figure_.chest >= 0) {
      const std::vector<int> way = path(figure_.chest, arm.upper);  // the collar's joints
      for (std::size_t k = 0; k + 1 < way.size(); ++k) {
        const Vec3 along = bone(way[k], way[k + 1]);
        const double rise = along.norm() > 0 ? std::clamp(along.y() / along.norm(), -0.1, 0.3) : 0;
        aim(way[k], along, std::sqrt(1 - rise * rise) * out + rise * Vec3::UnitY());
      }
    }
    if (arm.lower >= 0) aim_chain(arm.upper, arm.lower, out);
    if (arm.end >= 0) {
      aim_chain(arm.lower, arm.end, out);
      aim(arm.end, to_children(arm.end), out);
    }
  }

  void set_leg(const FigureLimb& leg, TPoseFrom kind) {
    if (figure_.legs.size() != 2) return;
    const Vec3 down = -Vec3::UnitY();
    const Mat3 foot = leg.end >= 0 ? rotation(leg.end) : Mat3::Identity().eval();
    if (leg.lower >= 0) aim_chain(leg.upper, leg.lower, down);
    if (leg.end < 0) return;
    const double shin = bone(leg.lower, leg.end).norm();
    aim_chain(leg.lower, leg.end, down);
    if (kind == TPoseFrom::k_standing) {  // the sole stays as it is
      turn(leg.end, axes_ * foot * rotation(leg.end).inverse() * axes_.transpose());
      return;
    }
    const Vec3 front = side_.cross(Vec3::UnitY()), toes = to_children(leg.end);
    const double length = toes.norm() / static_cast<double>(std::max<std::size_t>(1, children_[at(leg.end)].size()));
    const double fall = std::min(0.5, length > 0 ? 0.17 * shin / length : 0);  // an ankle is so high above the toes
    aim(leg.end, toes, std::sqrt(1 - fall * fall) * front - fall * Vec3::UnitY());
    for (const int toe : children_[at(leg.end)]) aim(toe, to_children(toe), front);
  }

  Mat3 rotation(int node) const { return pose_.globals[at(node)].topLeftCorner<3, 3>(); }

  /// A limb's bone, which other joints (twist bones) may part: all of them are straightened.
  void aim_chain(int from, int to, const Vec3& direction) {
    int node = from;
    for (const int next : path(from, to)) {
      aim(node, bone(node, next), direction);
      node = next;
    }
  }

  const Character& character_;
  const Figure& figure_;
  BindPose pose_;
  Mat3 axes_;
  std::vector<std::vector<int>> children_;
  Vec3 side_ = Vec3::UnitX();
  bool swapped_ = false;
  double reach_ = 0;  ///< longest bone [file units]
};

}  // namespace

Vec3 trunk_of(const Figure& figure, std::span<const Mat4> globals) {
  if (!figure.has_trunk()) return Vec3::Zero();
  const Vec3 low = 0.5 * (place(globals, figure.legs[0].upper) + place(globals, figure.legs[1].upper));
  if (figure.neck >= 0) return place(globals, figure.neck) - low;
  return 0.5 * (place(globals, figure.arms[0].upper) + place(globals, figure.arms[1].upper)) - low;
}

std::optional<double> trunk_to_legs(const Character& character, const Figure& figure, std::span<const Mat4> globals) {
  const Vec3 trunk = trunk_of(figure, globals);
  Vec3 legs = Vec3::Zero();
  double length = 0;
  if (figure.has_trunk())
    for (const FigureLimb& leg : figure.legs) {
      int end = leg.end;
      for (std::size_t i = 0; end < 0 && leg.lower >= 0 && i < character.nodes.size(); ++i)
        if (character.nodes[i].parent == leg.lower) end = static_cast<int>(i);
      if (end < 0) end = leg.lower;
      if (end < 0) continue;
      legs += place(globals, end) - place(globals, leg.upper);
      if (leg.lower != end) length += (place(globals, end) - place(globals, leg.lower)).norm();
      length += (place(globals, leg.lower) - place(globals, leg.upper)).norm();
    }
  // Legs that point opposite ways have no direction together.
  if (!(trunk.norm() > 0) || !(legs.norm() > 0.2 * length)) return std::nullopt;
  return trunk.dot(legs) / (trunk.norm() * legs.norm());
}

BindPose t_pose(const Character& character, const Figure& figure, const BindPose& from, const Mat3& axes,
                TPoseFrom kind) {
  return TPoser(character, figure, from, axes).make(kind);
}

}  // namespace ft::inline io

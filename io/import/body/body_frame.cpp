#include "io/import/body/body_frame.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

/// Between the middles of two knees or ankles: nearer, and legs grow together (the smooth union of two calves of radius
/// 0.035); parted, they have air between them [shares of the height].
constexpr double k_legs_touch = 0.095, k_legs_apart = 0.125;

bool is_end(const Character& character, std::size_t joint) {
  return is_end_site(character.nodes[joint]);
}

/// Turns a joint and all below it about the joint; turn is in the frame's axes.
void turn_joint(BodyFrame& frame, int top, const Mat3& turn) {
  const Vec3 centre = frame.joints[at(top)], pivot = frame.globals[at(top)].topRightCorner<3, 1>();
  const Mat3 turn_in_file = frame.axes.transpose() * turn * frame.axes;
  Mat4 move = Mat4::Identity();
  move.topLeftCorner<3, 3>() = turn_in_file;
  move.topRightCorner<3, 1>() = pivot - turn_in_file * pivot;
  std::vector<int> stack{top};
  while (!stack.empty()) {
    const auto joint = at(stack.back());
    stack.pop_back();
    frame.globals[joint] = move * frame.globals[joint];
    frame.joints[joint] = centre + turn * (frame.joints[joint] - centre);
    stack.insert(stack.end(), frame.children[joint].begin(), frame.children[joint].end());
  }
}

/// Turns an arm that points down by more than 45 degrees about its shoulder until it points sideways.
void raise_arms(BodyFrame& frame, const Landmarks& marks) {
  for (const int arm : marks.arms) {
    const Vec3 shoulder = frame.joints[at(arm)];
    Vec3 along = Vec3::Zero();
    for (const int elbow : frame.children[at(arm)]) along += frame.joints[at(elbow)] - shoulder;
    if (along.norm() < 1e-6 || along.normalized().y() > -0.7) continue;
    const Vec3 middle = 0.5 * (frame.joints[at(marks.arms[0])] + frame.joints[at(marks.arms[1])]);
    const double sign = (shoulder - middle).dot(marks.side);
    turn_joint(frame, arm, Quat::FromTwoVectors(along, sign < 0 ? Vec3(-marks.side) : marks.side).toRotationMatrix());
    frame.arms_raised = true;
  }
}

/// Turns legs whose knees or ankles are nearer than their flesh is wide outwards, each about its hip; the soles stay
/// level.
void part_legs(BodyFrame& frame, const Landmarks& marks) {
  const auto& legs = frame.figure.legs;
  if (legs[0].lower < 0 || legs[1].lower < 0) return;
  const auto between = [&](int a, int b) {
    return a < 0 || b < 0 ? k_legs_apart : (frame.joints[at(a)] - frame.joints[at(b)]).dot(marks.side);
  };
  const double knees = between(legs[0].lower, legs[1].lower), ankles = between(legs[0].end, legs[1].end);
  if (std::min(knees, ankles) >= k_legs_touch) return;
  for (const std::size_t k : {0u, 1u}) {
    const double sign = k == 0 ? 1 : -1;  // side points to the first leg
    const auto spread = [&](int joint, double now) {
      const Vec3 leg = frame.joints[at(joint)] - frame.joints[at(legs[k].upper)];
      return std::asin(std::clamp(0.5 * (k_legs_apart - now) / std::max(leg.norm(), 1e-6), 0.0, 0.4));
    };
    double angle = spread(legs[k].lower, knees);
    if (legs[k].end >= 0) angle = std::max(angle, spread(legs[k].end, ankles));
    // About the axis that takes down to the leg's own side.
    const Vec3 axis = Vec3(-Vec3::UnitY()).cross(Vec3(sign * marks.side)).normalized();
    turn_joint(frame, legs[k].upper, Eigen::AngleAxisd(angle, axis).toRotationMatrix());
    if (legs[k].end >= 0) turn_joint(frame, legs[k].end, Eigen::AngleAxisd(-angle, axis).toRotationMatrix());
  }
  frame.legs_parted = true;
}

}  // namespace

Landmarks find_landmarks(const Character& character, const BodyFrame& frame, const std::vector<Limb>& limb) {
  Landmarks out;
  const Figure& figure = frame.figure;
  Vec3 toes = Vec3::Zero();
  const auto at = [&](int joint) -> const Vec3& { return frame.joints[static_cast<std::size_t>(joint)]; };
  for (std::size_t i = 0; i < limb.size(); ++i) {
    if (is_end(character, i) || !frame.members[i] || limb[i] != Limb::k_foot) continue;
    for (const int child : frame.children[i]) toes += at(child) - at(static_cast<int>(i));
  }
  out.neck = figure.neck;
  for (const FigureLimb& leg : figure.legs) out.thighs.push_back(leg.upper);
  for (const FigureLimb& arm : figure.arms) out.arms.push_back(arm.upper);
  out.complete = out.thighs.size() == 2 && out.arms.size() == 2 && figure.base >= 0 &&
                 at(out.arms[0]).y() > at(out.thighs[0]).y() + 0.1;
  if (!out.complete) return out;
  out.hips = figure.hips;
  out.side = at(out.thighs[0]) - at(out.thighs[1]);
  out.side.y() = 0;
  out.side = out.side.norm() > 1e-6 ? out.side.normalized() : Vec3::UnitX().eval();
  toes.y() = 0;
  toes -= toes.dot(out.side) * out.side;
  out.forward = toes.norm() > 1e-6 ? toes.normalized() : out.side.cross(Vec3::UnitY()).eval();
  out.chest = figure.chest;
  for (int joint = out.chest; joint >= 0; joint = character.nodes[static_cast<std::size_t>(joint)].parent) {
    out.spine.insert(out.spine.begin(), joint);
    if (joint == out.hips) break;
  }
  return out;
}

Result<BodyFrame> body_frame(const Character& character, int root, const Mat3& axes, std::span<const Mat4> globals) {
  BodyFrame frame;
  frame.axes = axes;
  const std::vector<Limb> limb = limbs_by_name(character);
  frame.figure = find_figure(character, limb, root);
  frame.globals.assign(globals.begin(), globals.end());
  frame.children.resize(character.nodes.size());
  frame.members = figure_nodes(character, limb);
  std::vector<char> below_root(character.nodes.size(), 0);
  Box box;
  for (std::size_t i = 0; i < character.nodes.size(); ++i) {
    const int above = character.nodes[i].parent;
    below_root[i] = static_cast<int>(i) == root || (above >= 0 && below_root[static_cast<std::size_t>(above)]);
    frame.members[i] = frame.members[i] && below_root[i];
    frame.joints.push_back(axes * frame.globals[i].topRightCorner<3, 1>());
    if (frame.members[i]) box.include(frame.joints.back());
    if (const int parent = character.nodes[i].parent; parent >= 0 && frame.members[i])
      frame.children[static_cast<std::size_t>(parent)].push_back(static_cast<int>(i));
  }
  const double height = box.size().y();
  if (!(height > 1e-9) || !(box.size().norm() < 20 * height))
    return input_error("no body can be built: the skeleton has no height in its rest pose", "",
                       "check up = ..., or use a file with a mesh");
  frame.scale = 1 / height;
  for (Vec3& p : frame.joints) p *= frame.scale;
  const Landmarks marks = find_landmarks(character, frame, limb);
  if (marks.complete) raise_arms(frame, marks), part_legs(frame, marks);
  return frame;
}

}  // namespace ft::inline io

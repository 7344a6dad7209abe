#include "samples/tools/figure.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ft::sets {
namespace {

/// Takes an arm that points sideways, with the elbow's hinge upright, to `along` with the hinge at `hinge`.
Mat3 arm_turn(double side, const Vec3& along, const Vec3& hinge) {
  Mat3 from, to;
  from << Vec3(side, 0, 0), Vec3(0, -side, 0), Vec3(0, 0, -1);
  to << along, hinge, along.cross(hinge);
  return to * from.transpose();
}

}  // namespace

double smooth(double from, double to, double t) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

Mat3 pitch(double angle) {
  return Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix();
}

Mat3 yaw(double angle) {
  return Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
}

/// Of a child 1.2 m tall.
std::vector<Figure::Joint> Figure::skeleton() {
  std::vector<Joint> out{
      {"Hips", -1, {0, 0.635, 0}, {0, 0, 0}},       {"Spine", k_hips, {0, 0.06, 0}, {0, 0, 0}},
      {"Spine1", k_spine, {0, 0.09, 0}, {0, 0, 0}}, {"Chest", k_waist, {0, 0.09, 0}, {0, 0, 0}},
      {"Neck", k_chest, {0, 0.11, 0}, {0, 0, 0}},   {"Head", k_neck, {0, 0.05, 0.005}, {0, 0.17, 0}}};
  for (const double s : {1.0, -1.0}) {
    const bool left = s > 0;
    const int first = static_cast<int>(out.size());
    out.push_back({left ? "LeftShoulder" : "RightShoulder", k_chest, {0.02 * s, 0.07, 0}, {0, 0, 0}});
    out.push_back({left ? "LeftArm" : "RightArm", first, {0.10 * s, 0.01, 0}, {0, 0, 0}});
    out.push_back({left ? "LeftForeArm" : "RightForeArm", first + 1, {0.20 * s, 0, 0}, {0, 0, 0}});
    out.push_back({left ? "LeftHand" : "RightHand", first + 2, {0.17 * s, 0, 0}, {0.07 * s, 0, 0}});
  }
  for (const double s : {1.0, -1.0}) {
    const bool left = s > 0;
    const int first = static_cast<int>(out.size());
    out.push_back({left ? "LeftUpLeg" : "RightUpLeg", k_hips, {0.075 * s, -0.03, 0}, {0, 0, 0}});
    out.push_back({left ? "LeftLeg" : "RightLeg", first, {0, -0.27, 0}, {0, 0, 0}});
    out.push_back({left ? "LeftFoot" : "RightFoot", first + 1, {0, -0.255, 0}, {0, 0, 0}});
    out.push_back({left ? "LeftToeBase" : "RightToeBase", first + 2, {0, -0.045, 0.09}, {0, 0, 0.05}});
  }
  return out;
}

Figure::Figure(double height) : size_(height / 1.2), joints_(skeleton()) {
  for (Joint& joint : joints_) joint.offset *= size_, joint.end *= size_;
}

double Figure::standing() const {
  return joints_[k_hips].offset.y();
}
double Figure::hip_drop() const {
  return -joints_[k_legs].offset.y();
}
Vec3 Figure::hip_joint(const Pose& pose, int side) const {
  return pose.hips + turns_of_trunk(pose)[k_hips] * joints_[static_cast<std::size_t>(k_legs + 4 * side)].offset;
}
Vec3 Figure::ball() const {
  return joints_[k_legs + 3].offset;
}
double Figure::thigh() const {
  return joints_[k_legs + 1].offset.norm();
}
double Figure::shin() const {
  return joints_[k_legs + 2].offset.norm();
}
double Figure::ankle() const {
  return standing() - hip_drop() - thigh() - shin();
}

std::string Figure::bvh(const std::vector<Pose>& poses, double fps) const {
  std::string out = "HIERARCHY\n";
  int at_joint = 0;
  write_joint(out, at_joint, 0);
  out += fmt::format("MOTION\nFrames: {}\nFrame Time: {:.9f}\n", poses.size(), 1 / fps);
  for (const Pose& pose : poses) write_pose(out, pose);
  return out;
}

Figure::Turns Figure::turns_of_trunk(const Pose& pose) {
  const auto between = [&](double s) { return yaw(pose.pelvis_turn + s * (pose.chest_turn - pose.pelvis_turn)); };
  Turns out;
  out[k_hips] = between(0) * pitch(-pose.tilt - 0.5 * pose.lean);
  out[k_spine] = between(0.3) * pitch(-pose.tilt - 0.7 * pose.lean);
  out[k_waist] = between(0.7) * pitch(-pose.tilt - 0.9 * pose.lean);
  out[k_chest] = between(1) * pitch(-pose.tilt - pose.lean);
  out[k_neck] = yaw(0.4 * pose.chest_turn) * pitch(-0.7 * (pose.tilt + pose.lean));
  out[k_head] = pitch(-0.4 * (pose.tilt + pose.lean));
  return out;
}

Figure::Turns Figure::turns(const Pose& pose) const {
  Turns out = turns_of_trunk(pose);
  for (const int side : {0, 1}) {
    const auto s = static_cast<std::size_t>(side), leg = k_legs + 4 * s;
    out[leg] = pitch(-pose.thigh[s]);
    out[leg + 1] = pitch(-pose.shin[s]);
    out[leg + 2] = pitch(-pose.foot[s]);
    out[leg + 3] = pitch(-pose.foot[s] - pose.toes[s]);
    reach(pose, side, out);
  }
  return out;
}

/// Bends an arm so that the middle of the hand is at `grip`, the elbow low.
void Figure::reach(const Pose& pose, int side, Turns& turns) const {
  const auto arm = static_cast<std::size_t>(k_arms + 4 * side);
  turns[arm] = turns[k_chest];
  Vec3 shoulder = pose.hips;
  for (const std::size_t j : {std::size_t{k_spine}, std::size_t{k_waist}, std::size_t{k_chest}, arm, arm + 1})
    shoulder += turns[static_cast<std::size_t>(joints_[j].parent)] * joints_[j].offset;
  const double sign = side == 0 ? 1 : -1, upper = joints_[arm + 2].offset.norm(),
               lower = joints_[arm + 3].offset.norm() + 0.6 * joints_[arm + 3].end.norm();
  const Vec3 way = pose.grip[static_cast<std::size_t>(side)] - shoulder, along = way.normalized();
  const double far = std::clamp(way.norm(), 1.02 * std::abs(upper - lower), 0.995 * (upper + lower));
  const double to_elbow = (upper * upper - lower * lower + far * far) / (2 * far);
  const Vec3 low = turns[k_chest] * Vec3(pose.elbows.x() * sign, pose.elbows.y(), pose.elbows.z());
  const Vec3 out = (low - low.dot(along) * along).normalized();
  const Vec3 elbow = to_elbow * along + std::sqrt(upper * upper - to_elbow * to_elbow) * out;
  const Vec3 fore = (far * along - elbow).normalized(), hinge = elbow.cross(fore).normalized();
  turns[arm + 1] = arm_turn(sign, elbow.normalized(), hinge);
  turns[arm + 2] = turns[arm + 3] = arm_turn(sign, fore, hinge);
}

void Figure::write_joint(std::string& out, int& at_joint, int depth) const {
  const int own = at_joint++;
  const Joint& joint = joints_[static_cast<std::size_t>(own)];
  const std::string tab(static_cast<std::size_t>(depth), '\t');
  const auto offset = [&](const Vec3& p) { return fmt::format("OFFSET {:.5f} {:.5f} {:.5f}\n", p.x(), p.y(), p.z()); };
  out += fmt::format("{}{} {}\n{}{{\n{}\t{}{}\tCHANNELS {}Zrotation Xrotation Yrotation\n", tab,
                     own == 0 ? "ROOT" : "JOINT", joint.name, tab, tab, offset(joint.offset), tab,
                     own == 0 ? "6 Xposition Yposition Zposition " : "3 ");
  while (at_joint < k_joints && joints_[static_cast<std::size_t>(at_joint)].parent == own)
    write_joint(out, at_joint, depth + 1);
  if (joint.end != Vec3::Zero())
    out += fmt::format("{}\tEnd Site\n{}\t{{\n{}\t\t{}{}\t}}\n", tab, tab, tab, offset(joint.end), tab);
  out += tab + "}\n";
}

void Figure::write_pose(std::string& out, const Pose& pose) const {
  const Turns turned = turns(pose);
  out += fmt::format("{:.6f} {:.6f} {:.6f}", pose.hips.x(), pose.hips.y(), pose.hips.z());
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Mat3 r = turned[j];
    if (joints_[j].parent >= 0) r = turned[static_cast<std::size_t>(joints_[j].parent)].transpose() * r;
    out += fmt::format(" {:.4f} {:.4f} {:.4f}", std::atan2(-r(0, 1), r(1, 1)) / k_rad,
                       std::asin(std::clamp(r(2, 1), -1.0, 1.0)) / k_rad, std::atan2(-r(2, 0), r(2, 2)) / k_rad);
  }
  out += '\n';
}

}  // namespace ft::sets

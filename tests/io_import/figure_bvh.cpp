#include "tests/io_import/figure_bvh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace ft::test {
namespace {

constexpr int k_parents[k_figure_joints] = {-1, 0, 1, 2, 3, 2, 5, 6, 7, 2, 9, 10, 11, 0, 13, 14, 15, 0, 17, 18, 19};
/// The joint that a bone goes on to; 0: an end site.
constexpr int k_next[k_figure_joints] = {1, 2, 3, 4, 0, 6, 7, 8, 0, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20, 0};

Vec3 offset(int joint, double hips) {
  static const Vec3 k_offsets[k_figure_joints] = {
      {0, 0.95, 0},    {0, 0.12, 0},     {0, 0.20, 0},    {0, 0.22, 0},     {0, 0.10, 0},     {0.04, 0.16, 0},
      {0.13, 0.02, 0}, {0.28, 0, 0},     {0.25, 0, 0},    {-0.04, 0.16, 0}, {-0.13, 0.02, 0}, {-0.28, 0, 0},
      {-0.25, 0, 0},   {0.09, -0.03, 0}, {0, -0.43, 0},   {0, -0.43, 0},    {0, -0.06, 0.14}, {-0.09, -0.03, 0},
      {0, -0.43, 0},   {0, -0.43, 0},    {0, -0.06, 0.14}};
  Vec3 out = k_offsets[joint];
  if (joint == 13) out.x() = hips;
  if (joint == 17) out.x() = -hips;
  return out;
}

Vec3 end_offset(int joint) {
  if (joint == 4) return {0, 0.18, 0};
  if (joint == 8) return {0.16, 0, 0};
  if (joint == 12) return {-0.16, 0, 0};
  return {0, 0, 0.06};
}

Mat3 turn(int axis, double degrees) {
  return Eigen::AngleAxisd(degrees * M_PI / 180, Vec3::Unit(axis)).toRotationMatrix();
}

/// Global turn of a joint in the rest pose, against the T-pose in which offsets are given: what the file's offsets
/// leave out.
Mat3 rest_turn(const FigureKind& kind, int joint) {
  const bool left_arm = joint >= 6 && joint <= 8, right_arm = joint >= 10 && joint <= 12;
  const double down = kind.rest == FigureRest::k_a_pose ? 45 : kind.rest == FigureRest::k_arms_down ? 88 : 0;
  if (left_arm || right_arm) {
    if (down > 0) return turn(2, left_arm ? down : -down);
  }
  if ((kind.rest != FigureRest::k_bones_on_x && kind.rest != FigureRest::k_mirrored_x) || joint == 0)
    return Mat3::Identity();
  const bool right = (joint >= 9 && joint <= 12) || joint >= 17;
  const Vec3 along = k_next[joint] > 0 ? offset(k_next[joint], kind.hips) : end_offset(joint);
  const Vec3 x = (right && kind.rest == FigureRest::k_mirrored_x ? -along : along).normalized();
  const Vec3 hint = std::abs(x.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitY();
  const Vec3 z = (hint - hint.dot(x) * x).normalized();
  Mat3 out;
  out << x, z.cross(x), z;
  return out;
}

/// Local turn of a joint at a frame, from the T-pose: arms down by 60 degrees, a walk, turned about the vertical.
Mat3 motion(int joint, int frame) {
  const double swing = std::sin(0.5 * frame);
  if (joint == 0) return turn(1, 30 + 4 * frame);
  if (joint == 6) return turn(2, -60 - 15 * swing);
  if (joint == 10) return turn(2, 60 + 15 * swing);
  if (joint == 13) return turn(0, 25 * swing);
  if (joint == 17) return turn(0, -25 * swing);
  if (joint == 14 || joint == 18) return turn(0, 12);
  return Mat3::Identity();
}

std::string text(const char* how, double a, double b, double c) {
  char out[120];
  std::snprintf(out, sizeof out, how, a, b, c);
  return out;
}

}  // namespace

std::array<Vec3, k_figure_joints> figure_t_pose(double hips) {
  std::array<Vec3, k_figure_joints> out;
  for (int j = 0; j < k_figure_joints; ++j)
    out[at(j)] = (k_parents[j] < 0 ? Vec3::Zero().eval() : out[at(k_parents[j])]) + offset(j, hips);
  return out;
}

std::string figure_bvh(const FigureKind& kind, int frames) {
  const Mat3 up = kind.z_up ? turn(0, 90) : Mat3::Identity();
  const auto in_file = [&](const Vec3& p) -> Vec3 { return kind.units_per_metre * (up * p); };
  std::array<int, k_figure_joints> order{};
  int count = 0;
  std::string out = "HIERARCHY\n";
  if (kind.root != nullptr)
    out += std::string("ROOT ") + kind.root +
           "\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
  const std::function<void(int)> write = [&](int joint) {
    order[at(count++)] = joint;
    const int parent = k_parents[joint];
    const Mat3 above = parent < 0 ? Mat3::Identity().eval() : rest_turn(kind, parent);
    const Vec3 o = in_file(above.transpose() * offset(joint, kind.hips));
    out += std::string(parent < 0 && kind.root == nullptr ? "ROOT " : "JOINT ") + kind.names[at(joint)] + "\n{\n";
    out += text("OFFSET %.6f %.6f %.6f\n", o.x(), o.y(), o.z());
    out += parent < 0 ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                      : "CHANNELS 3 Zrotation Xrotation Yrotation\n";
    for (int child = 0; child < k_figure_joints; ++child)
      if (k_parents[child] == joint) write(child);
    if (k_next[joint] == 0) {
      const Vec3 e = in_file(rest_turn(kind, joint).transpose() * end_offset(joint));
      out += text("End Site\n{\nOFFSET %.6f %.6f %.6f\n}\n", e.x(), e.y(), e.z());
    }
    out += "}\n";
  };
  write(0);
  if (kind.root != nullptr) out += "}\n";
  out += "MOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: 0.0333333\n";
  for (int f = 0; f < frames; ++f) {
    if (kind.root != nullptr) out += "0 0 0 0 0 0 ";
    std::array<Mat3, k_figure_joints> pose;
    for (const int j : order) {
      const int parent = k_parents[j];
      pose[at(j)] = (parent < 0 ? Mat3::Identity().eval() : pose[at(parent)]) * motion(j, f);
      const Mat3 above = parent < 0 ? Mat3::Identity().eval() : Mat3(pose[at(parent)] * rest_turn(kind, parent));
      const Mat3 local = up * above.transpose() * pose[at(j)] * rest_turn(kind, j) * up.transpose();
      if (parent < 0) {
        const Vec3 p = in_file(Vec3(0.03 * f, 0.95, 0.02 * f));
        out += text("%.6f %.6f %.6f ", p.x(), p.y(), p.z());
      }
      const double x = std::asin(std::clamp(local(2, 1), -1.0, 1.0));
      constexpr double k_degrees = 180 / M_PI;
      out += text("%.6f %.6f %.6f ", std::atan2(-local(0, 1), local(1, 1)) * k_degrees, x * k_degrees,
                  std::atan2(-local(2, 0), local(2, 2)) * k_degrees);
    }
    out.back() = '\n';
  }
  return out;
}

}  // namespace ft::test

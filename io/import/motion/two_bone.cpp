#include "io/import/motion/two_bone.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

double bend(const TwoBonePose& pose) {
  const Vec3 a = pose.lower - pose.upper, b = pose.end - pose.lower;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double distance_at(const TwoBonePose& pose, double angle) {
  const double a = (pose.lower - pose.upper).norm(), b = (pose.end - pose.lower).norm();
  return std::sqrt(std::max(a * a + b * b + 2 * a * b * std::cos(angle), 0.0));
}

}  // namespace

Reach reach_of(const TwoBonePose& pose, const BendLimits& limits) {
  const double now = bend(pose);
  return {distance_at(pose, std::max(limits.most, now)), distance_at(pose, std::min(limits.least, now))};
}

TwoBoneTurn bend_to(const TwoBonePose& pose, const Vec3& target, const Vec3& axis, const BendLimits& limits) {
  const Vec3 to_knee = pose.lower - pose.upper, to_end = pose.end - pose.lower, to_target = target - pose.upper;
  const double a = to_knee.norm(), b = to_end.norm();
  TwoBoneTurn out;
  if (!(a > 0) || !(b > 0) || !(to_target.norm() > 0)) return out;
  const Reach reach = reach_of(pose, limits);
  const double r = std::clamp(to_target.norm(), reach.least, reach.most);
  const double angle = std::acos(std::clamp((r * r - a * a - b * b) / (2 * a * b), -1.0, 1.0));

  // What is bent further is bent about the usual axis: nothing jumps where a deviation begins, and a straight limb, the
  // axis of whose own bend is noise, bends the right way.
  const Vec3 along = to_knee / a, usual = axis - along * along.dot(axis);
  Vec3 n = along.cross(to_end / b) + std::max(angle - bend(pose), 0.0) * usual;
  n -= along * along.dot(n);
  n = n.norm() > 1e-9 ? Vec3(n.normalized()) : along.unitOrthogonal();
  out.lower = Quat(Eigen::AngleAxisd(angle, n)) * Quat::FromTwoVectors(to_end, to_knee);
  out.upper = Quat::FromTwoVectors(to_knee + out.lower * to_end, to_target);
  return out;
}

}  // namespace ft::inline io

#include "solvers/standins/unilateral_spring.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {

Result<std::unique_ptr<StandIn>> UnilateralSpring::make(const StandInSpec& s) {
  if (!(s.stiffness > 0)) return usage_error("a spring needs a stiffness above 0", s.name, "stiffness [N/m]");
  if (!(std::min({s.length, s.damping, s.damping_ratio}) >= 0))
    return usage_error("length and damping of a spring must be 0 or more", s.name);
  return std::unique_ptr<StandIn>(new UnilateralSpring(s));
}

bool UnilateralSpring::reaches(const BodyState& body, double margin) const {
  return (body.motion.pose * spec().anchor - spec().position).norm() > spec().length - margin;
}

StandInForce UnilateralSpring::law(const BodyState& body) const {
  const StandInSpec& s = spec();
  StandInForce out;
  const Vec3 arm = body.motion.pose.rotation * s.anchor, way = body.motion.pose.position + arm - s.position;
  const double length = way.norm();
  if (length <= s.length || length == 0) return out;
  const Vec3 n = way / length;
  const double c = s.damping + 2 * s.damping_ratio * std::sqrt(s.stiffness * body.mass);
  const Vec3 v = body.motion.velocity + body.motion.spin.cross(arm);
  const double tension = s.stiffness * (length - s.length) + c * n.dot(v);
  if (tension <= 0) return out;
  const Mat3 along = n * n.transpose();
  out.add(arm, -tension * n, s.stiffness * along + tension / length * (Mat3::Identity() - along), c * along);
  return out;
}

}  // namespace ft::inline solvers

#include "solvers/standins/carried_weight.h"

namespace ft::inline solvers {

Result<std::unique_ptr<StandIn>> CarriedWeight::make(const StandInSpec& s) {
  if (!(s.mass > 0)) return usage_error("a carried weight needs a mass above 0", s.name, "mass [kg]");
  return std::unique_ptr<StandIn>(new CarriedWeight(s));
}

StandInForce CarriedWeight::law(const BodyState& body) const {
  const double m = spec().mass;
  const Vec3 arm = body.motion.pose.rotation * spec().anchor;
  const Vec3 a = body.acceleration + body.spin_rate.cross(arm) + body.motion.spin.cross(body.motion.spin.cross(arm));
  StandInForce out;
  out.add(arm, m * (Vec3(0, -k_gravity, 0) - a), Mat3::Zero(), Mat3::Zero());
  const Mat3 x = cross_matrix(arm);
  out.inertia << m * Mat3::Identity(), -m * x, m * x, -m * x * x;
  return out;
}

}  // namespace ft::inline solvers

#include "solvers/standins/fitted_field.h"

namespace ft::inline solvers {

Result<std::unique_ptr<StandIn>> FittedField::make(const StandInSpec& s) {
  if (!(s.stiffness >= 0)) return usage_error("stiffness of a fitted stand-in must be 0 or more", s.name);
  if (auto fault = check(s, s.stiffness > 0)) return *fault;
  return std::unique_ptr<StandIn>(new FittedField(s));
}

StandInForce FittedField::law(const BodyState& body) const {
  StandInForce out = DampingVolume::law(body);
  const double k = share(body) * spec().stiffness;
  out.wrench.force -= k * (body.motion.pose.position - spec().position);
  out.stiffness.topLeftCorner<3, 3>() += k * Mat3::Identity();
  return out;
}

}  // namespace ft::inline solvers

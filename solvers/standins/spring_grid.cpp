#include "solvers/standins/spring_grid.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {

Result<std::unique_ptr<StandIn>> SpringGrid::make(const StandInSpec& s) {
  if (!(s.size.x() > 0 && s.size.z() > 0)) return usage_error("a mat needs a size above 0 in x and z", s.name);
  if (!(std::min({s.stiffness, s.stiffness_cubic, s.damping, s.damping_ratio}) >= 0))
    return usage_error("stiffness and damping of a mat must be 0 or more", s.name);
  if (s.stiffness == 0 && s.stiffness_cubic == 0)
    return usage_error("a mat needs a stiffness", s.name, "stiffness [N/m]; a landing mat has 66e3");
  return std::unique_ptr<StandIn>(new SpringGrid(s));
}

double SpringGrid::cover(const Vec3& place) const {
  const Vec3 p = local(place);
  return ramp(std::min(0.5 * spec().size.x() - std::abs(p.x()), 0.5 * spec().size.z() - std::abs(p.z())));
}

bool SpringGrid::reaches(const BodyState& body, double margin) const {
  const auto at_mat = [&](const Vec3& place) { return place.y() < spec().position.y() + margin && cover(place) > 0; };
  if (body.shape.empty()) return at_mat(body.motion.pose.position);
  return std::any_of(body.shape.begin(), body.shape.end(),
                     [&](const ShapeSample& s) { return s.area > 0 && at_mat(body.motion.pose * s.place); });
}

StandInForce SpringGrid::law(const BodyState& body) const {
  const StandInSpec& s = spec();
  StandInForce out;
  const double c = s.damping + 2 * s.damping_ratio * std::sqrt(s.stiffness * body.mass);
  const auto push = [&](const ShapeSample& sample, double share) {
    const Vec3 arm = body.arm(sample), place = body.motion.pose.position + arm;
    const double depth = s.position.y() - place.y();
    if (depth <= 0) return;
    const double weight = share * cover(place), sinking = -body.velocity(sample, arm).y();
    const double force = s.stiffness * depth + s.stiffness_cubic * depth * depth * depth + c * sinking;
    if (weight == 0 || force <= 0) return;
    const Mat3 up = Vec3::Unit(1) * Vec3::Unit(1).transpose();
    out.add(arm, weight * force * Vec3::UnitY(), weight * (s.stiffness + 3 * s.stiffness_cubic * depth * depth) * up,
            weight * c * up, body.motion.pose.rotation * sample.velocity);
  };
  if (body.shape.empty()) push({}, 1);
  const auto underside = [&](const ShapeSample& sample) {
    return sample.area * std::max(0.0, -(body.motion.pose.rotation * sample.normal).y());
  };
  double all = 0;
  for (const ShapeSample& sample : body.shape) all += underside(sample);
  for (const ShapeSample& sample : body.shape)
    if (const double area = underside(sample); area > 0) push(sample, area / all);
  return out;
}

}  // namespace ft::inline solvers

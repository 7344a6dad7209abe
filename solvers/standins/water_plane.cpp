#include "solvers/standins/water_plane.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

double extent(const ShapeSample& s) {
  return s.volume > 0 ? std::cbrt(s.volume) : std::sqrt(s.area);
}

}  // namespace

Result<std::unique_ptr<StandIn>> WaterPlane::make(const StandInSpec& s) {
  if (!(s.density > 0)) return usage_error("water needs a density above 0", s.name, "1000 kg/m3");
  if (!(std::min(s.drag, s.slam) >= 0)) return usage_error("drag and slam of water must be 0 or more", s.name);
  return std::unique_ptr<StandIn>(new WaterPlane(s));
}

bool WaterPlane::reaches(const BodyState& body, double margin) const {
  const double level = spec().position.y() + margin;
  return std::any_of(body.shape.begin(), body.shape.end(),
                     [&](const ShapeSample& s) { return (body.motion.pose * s.place).y() - 0.5 * extent(s) < level; });
}

StandInForce WaterPlane::law(const BodyState& body) const {
  StandInForce out;
  for (const ShapeSample& sample : body.shape) {
    const double size = extent(sample);
    if (size <= 0) continue;
    const Vec3 arm = body.arm(sample);
    const double depth = spec().position.y() - body.motion.pose.position.y() - arm.y();
    const double w = std::clamp(depth / size + 0.5, 0.0, 1.0);
    if (w == 0) continue;
    const Vec3 own = body.motion.pose.rotation * sample.velocity;
    if (sample.volume > 0) {
      const double lift = spec().density * k_gravity * sample.volume;
      Mat3 stiffness = Mat3::Zero();
      if (w < 1) stiffness(1, 1) = lift / size;
      out.add(arm, w * lift * Vec3::UnitY(), stiffness, Mat3::Zero(), own);
    }
    const Vec3 v = body.velocity(sample, arm), n = body.motion.pose.rotation * sample.normal;
    const double head_on = n.dot(v);
    if (sample.area <= 0 || head_on <= 0) continue;
    const double slam = v.y() < 0 ? spec().slam * 4 * w * (1 - w) : 0;
    const double factor = 0.5 * spec().density * (spec().drag * w + slam) * sample.area;
    out.add(arm, -factor * head_on * v, Mat3::Zero(), factor * (head_on * Mat3::Identity() + v * n.transpose()), own);
  }
  return out;
}

}  // namespace ft::inline solvers

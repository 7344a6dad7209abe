#include "solvers/wind/plain_flows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::inline solvers {
namespace {

using std::numbers::pi;

/// A law of the place alone.
template <class Law>
class Steady final : public AirNow {
 public:
  explicit Steady(Law law) : law_(std::move(law)) {}
  Vec3 velocity(const Vec3& place) const override { return law_(place); }

 private:
  Law law_;
};

template <class Law>
std::unique_ptr<AirNow> steady(Law law) {
  return std::make_unique<Steady<Law>>(std::move(law));
}

Status check_radius(const WindFieldSpec& spec) {
  if (!(spec.radius > 0)) return usage_error("radius must be above 0", spec.name);
  return {};
}

}  // namespace

Result<std::unique_ptr<WindField>> Source::make(const WindFieldSpec& spec) {
  if (Status status = check_radius(spec); !status) return status.error();
  if (spec.flow == 0) return usage_error("a " + spec.kind + " without a flow moves nothing", spec.name, "flow = 2");
  return std::unique_ptr<WindField>(std::make_unique<Source>(spec));
}

Result<std::unique_ptr<WindField>> Source::make_sink(const WindFieldSpec& spec) {
  WindFieldSpec inwards = spec;
  inwards.flow = -spec.flow;
  return make(inwards);
}

std::unique_ptr<AirNow> Source::at_time(double) const {
  const double share = spec().flow / (4 * pi), core = spec().radius;
  return steady([centre = spec().position, share, core](const Vec3& place) -> Vec3 {
    const Vec3 r = place - centre;
    const double distance = std::max(r.norm(), core);
    return share / (distance * distance * distance) * r;
  });
}

double Source::fastest() const {
  return std::abs(spec().flow) / (4 * pi * spec().radius * spec().radius);
}

Result<std::unique_ptr<WindField>> Vortex::make(const WindFieldSpec& spec) {
  if (Status status = check_radius(spec); !status) return status.error();
  if (!(spec.axis.norm() > 0)) return usage_error("a vortex about no axis has no direction", spec.name);
  if (spec.circulation == 0)
    return usage_error("a vortex without a circulation moves nothing", spec.name, "circulation = 5");
  return std::unique_ptr<WindField>(std::make_unique<Vortex>(spec));
}

std::unique_ptr<AirNow> Vortex::at_time(double) const {
  const Vec3 axis = spec().axis.normalized();
  const double share = spec().circulation / (2 * pi), core2 = spec().radius * spec().radius;
  return steady([centre = spec().position, axis, share, core2](const Vec3& place) -> Vec3 {
    const Vec3 r = place - centre, around = axis.cross(r);
    const double r2 = around.squaredNorm();
    // -expm1(-s) / s is 1 on the axis.
    return share / core2 * (r2 > 1e-12 * core2 ? -std::expm1(-r2 / core2) * core2 / r2 : 1.0) * around;
  });
}

/// At r = 1.121 R (Lamb and Oseen).
double Vortex::fastest() const {
  return 0.6382 * std::abs(spec().circulation) / (2 * pi * spec().radius);
}

Vec3 doublet_velocity(const Vec3& r, const Vec3& velocity, double radius) {
  const double r2 = r.squaredNorm();
  if (r2 <= radius * radius) return velocity;
  const double share = radius * radius * radius / (2 * r2 * std::sqrt(r2));
  return share * (3 * velocity.dot(r) / r2 * r - velocity);
}

Result<std::unique_ptr<WindField>> Doublet::make(const WindFieldSpec& spec) {
  if (Status status = check_radius(spec); !status) return status.error();
  if (spec.velocity == Vec3::Zero())
    return usage_error("a doublet is the flow about a sphere that moves, and has no velocity", spec.name,
                       "velocity = [5, 0, 0]");
  return std::unique_ptr<WindField>(std::make_unique<Doublet>(spec));
}

std::unique_ptr<AirNow> Doublet::at_time(double) const {
  return steady([centre = spec().position, v = spec().velocity, radius = spec().radius](const Vec3& place) {
    return doublet_velocity(place - centre, v, radius);
  });
}

}  // namespace ft::inline solvers

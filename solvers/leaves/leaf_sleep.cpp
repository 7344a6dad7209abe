#include "solvers/leaves/leaf_sleep.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {

double holding_pressure(const LeafPrototype& prototype, double mass_factor, double gravity) {
  return prototype.mass_per_area * mass_factor * gravity + prototype.adhesion;
}

double lift_off_speed(const LeafPrototype& prototype, double mass_factor, double friction, double gravity,
                      double air_density) {
  const double hold = holding_pressure(prototype, mass_factor, gravity);
  // 3/4 of the lift's half rho C_L u2, against 1/2.
  const double peel = 4.0 / 3 * hold / (air_density * prototype.lying_lift);
  const double slide = 2 * friction * hold / (air_density * (prototype.lying_drag + friction * prototype.lying_lift));
  return std::sqrt(std::min(peel, slide));
}

LyingForce lying_force(const LeafPrototype& prototype, const PlateModel& plate, const Vec3& ground, const Vec3& air,
                       std::span<const Vec3> rim) {
  LyingForce out;
  const Vec3 along = air - air.dot(ground) * ground;
  const double speed = along.norm();
  if (speed < 1e-9) return out;
  const Vec3 direction = along / speed;
  double windward = 0;
  for (const Vec3& p : rim) windward = std::min(windward, p.dot(direction));
  const double pressure = 0.5 * plate.air_density * plate.area * speed * speed;
  const Vec3 lift = prototype.lying_lift * pressure * ground;
  out.force = lift + prototype.lying_drag * pressure * direction;
  out.torque = (0.5 * windward * direction).cross(lift);
  return out;
}

}  // namespace ft::inline solvers

// What a lying leaf holds out against, and when it sleeps.
//
// Air that runs over a lying leaf draws at it with 1/2 rho C_L S u^2, C_L the shape's lying_lift, at the quarter of its
// length that is nearest to the wind. It comes off by its windward edge, turning about the lee one, as soon as that has
// the larger moment than weight and adhesion in the middle: 3/4 of the length against 1/2. Or it slides first, where
// drag exceeds the friction of what is left of both. Asleep it does not move below the lesser of these two speeds;
// above it is awake, its adhesion is gone, and the plate's own law takes over as it tilts.
#pragma once

#include "solvers/leaves/leaves_setup.h"

namespace ft::inline solvers {

/// What holds a leaf down, per area [N/m2].
double holding_pressure(const LeafPrototype& prototype, double mass_factor, double gravity);

/// Speed of level air above which a sleeping leaf comes off [m/s]. mass_factor: this leaf's mass by the prototype's.
double lift_off_speed(const LeafPrototype& prototype, double mass_factor, double friction, double gravity = k_gravity,
                      double air_density = 1.225);

/// Slower than this, with what its rim does, for as long, a leaf that touches something at rest falls asleep.
constexpr double k_sleep_speed = 0.02;  ///< m/s
constexpr double k_sleep_after = 0.4;   ///< s
/// Share of the lift-off speed below which the wind has to be for that [1].
constexpr double k_sleep_wind = 0.95;

/// Forces on a leaf that lies, of the air that runs over it along the ground.
struct LyingForce {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< world [N], [N m]
};
/// ground: unit normal of what it lies on; air: velocity past the leaf [m/s]; rim: the leaf's points about its centre
/// of mass, world [m].
LyingForce lying_force(const LeafPrototype& prototype, const PlateModel& plate, const Vec3& ground, const Vec3& air,
                       std::span<const Vec3> rim);

}  // namespace ft::inline solvers

#include "solvers/leaves/leaf_float.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

constexpr double k_water = 1000;                                        ///< density [kg/m3]
constexpr double k_water_viscosity = 1.0e-6, k_air_viscosity = 1.5e-5;  ///< kinematic, at 20 degrees [m2/s]
/// Of heave and leaning, by critical damping [1]. Discs of a few centimetres radiate between half and all of it at
/// their own frequency.
constexpr double k_damping = 0.7;
/// A flat plate sinks its meniscus no deeper than 2 l sin(theta / 2), l 2.7 mm: flooded beyond, for contact angles of
/// leaves, 90 degrees and more [m]. It draws up less before it comes off; less than water without water lies below
/// ground.
constexpr double k_flooded = 4e-3, k_holds = 1.5e-3;
/// A flooded leaf is afloat again so near the surface [m].
constexpr double k_surfaced = 1e-3;
/// What is deeper and was never on the water is not in it but under what holds it [m].
constexpr double k_deepest = 0.25;
/// Of wet leaves, by water's: what makes flooded ones rise [1].
constexpr double k_density = 0.7;
constexpr double k_face_on = 1.2;  ///< drag coefficient of a plate [1]

/// Rate at which skin friction takes away a velocity past the plate, by the plate's mass [1/s].
double skin_rate(const PlateModel& p, double density, double viscosity, double speed) {
  const double length = 2 * p.half_chord[1];
  return 0.5 * density * p.area * 1.328 * std::sqrt(speed * viscosity / length) / p.mass;
}

/// Damped spring, implicit: the velocity after `time` of what is off by `offset` and goes back at -velocity.
double spring_step(double mass, double stiffness, double most, double offset, double velocity, double time) {
  const double damping = 2 * k_damping * std::sqrt(stiffness * mass);
  if (std::abs(stiffness * offset) > most)
    return (mass * velocity + time * std::copysign(most, offset)) / (mass + time * damping);
  return (mass * velocity + time * stiffness * offset) / (mass + time * damping + time * time * stiffness);
}

}  // namespace

FloatingPlate floating_plate(const PlateModel& plate, std::span<const Vec3> positions, double gravity) {
  FloatingPlate out;
  // Water is below, air above: half of what a plate in water takes along.
  const double water = 0.5 * k_water / plate.air_density;
  out.mass = plate.mass + water * plate.added_mass[1];
  out.inertia = plate.inertia + water * plate.added_inertia;
  out.stiffness = k_water * gravity * plate.area;
  const Vec3 gyration = plate.inertia / plate.mass;  // squared
  out.lean = out.stiffness * Vec3(gyration[0], 0, gyration[2]);
  out.reach = std::sqrt(gyration[0] + gyration[2]);
  for (const Vec3& p : positions) {
    out.lowest = std::max(out.lowest, -p.y());
    out.lowest_flipped = std::max(out.lowest_flipped, p.y());
  }
  return out;
}

double float_depth(const FloatingPlate& floating, const WaterPatch& water, const FloatingMotion& m, double margin) {
  const bool flipped = (m.turn * Vec3::UnitY()).dot(water.normal) < 0;
  return water.level + margin + (flipped ? floating.lowest_flipped : floating.lowest) - m.place.y();
}

Afloat next_afloat(Afloat now, double depth, double gap, bool lies) {
  switch (now) {
    case Afloat::k_no:
      if (depth > k_flooded && depth < k_deepest) return Afloat::k_under;
      return lies && gap < k_holds ? Afloat::k_floats : Afloat::k_no;
    case Afloat::k_floats:
      if (depth > k_flooded) return Afloat::k_under;
      return gap > k_holds ? Afloat::k_no : Afloat::k_floats;
    case Afloat::k_under: break;
  }
  return depth < k_surfaced ? Afloat::k_floats : Afloat::k_under;
}

void enter_water(const PlateModel& p, const FloatingPlate& f, const WaterPatch& water, FloatingMotion& m) {
  const double rising = water.rising(m.velocity);
  m.velocity.y() = rising + p.mass / f.mass * (m.velocity.y() - rising);
  const Vec3 spin = m.turn.conjugate() * (m.spin - water.turning);
  m.spin = water.turning + m.turn * p.inertia.cwiseQuotient(f.inertia).cwiseProduct(spin);
}

void advance_float(const PlateModel& p, const FloatingPlate& f, Afloat afloat, const Vec3& gravity, const Vec3& air,
                   const WaterPatch& before, const WaterPatch& after, double depth, double time, FloatingMotion& m) {
  const double weight = gravity.norm();
  const bool under = afloat == Afloat::k_under;

  // Up and down, as it goes past the surface.
  double rise = m.velocity.y() - before.rising(m.velocity);
  Vec3 along = m.velocity;
  if (under) {
    const double lift = p.mass * weight * (1 / k_density - 1);
    rise = (f.mass * rise + time * lift) / (f.mass + time * 0.5 * k_water * p.area * k_face_on * std::abs(rise));
  } else {
    rise = spring_step(f.mass, f.stiffness, f.stiffness * k_flooded, depth, rise, time);
  }

  // Along: down the slope, with the water below and the air above.
  const Vec3 past_water = after.flow - along, past_air = air - along;
  const auto level_speed = [](const Vec3& v) { return std::hypot(v.x(), v.z()); };
  const double water_rate = skin_rate(p, k_water, k_water_viscosity, level_speed(past_water)) * (under ? 2 : 1);
  const double air_rate = under ? 0 : skin_rate(p, p.air_density, k_air_viscosity, level_speed(past_air));
  const Vec3 slide = under ? Vec3::Zero() : Vec3(-weight * after.slope.x(), 0, -weight * after.slope.y());
  along = (along + time * (slide + water_rate * after.flow + air_rate * air)) / (1 + time * (water_rate + air_rate));
  m.velocity = Vec3(along.x(), 0, along.z());
  m.velocity.y() = after.rising(m.velocity) + rise;

  // Leaning and turning, in the plate's axes.
  Vec3 own = m.turn.conjugate() * after.normal;
  if (own.y() < 0) own = -own;
  const Vec3 off = Vec3::UnitY().cross(own);
  Vec3 spin = m.turn.conjugate() * (m.spin - before.turning);
  for (const int axis : {0, 2}) {
    const double most = k_flooded * std::sqrt(f.lean[axis] * f.stiffness);  // as if the rim were as deep
    spin[axis] = spring_step(f.inertia[axis], f.lean[axis], most, off[axis], spin[axis], time);
  }
  spin[1] /= 1 + time * (water_rate + skin_rate(p, k_water, k_water_viscosity, std::abs(spin[1]) * f.reach));
  m.spin = m.turn * spin + after.turning;
}

double wind_drift(const PlateModel& p) {
  return std::pow(p.air_density / k_water * std::sqrt(k_air_viscosity / k_water_viscosity), 2.0 / 3);
}

}  // namespace ft::inline solvers

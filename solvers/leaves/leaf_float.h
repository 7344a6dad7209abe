// A leaf on water. It is caught where it comes to lie on the surface, and stays with it: it rides up and down, leans as
// the surface does, and goes where the water and the wind take it. What pushes it under lets it come up again.
//
// Across the surface (heave, and leaning alike): the leaf takes water along below it, half the added mass of its plate
// in water, M = m + m_a; what is above or below its place is pulled back by k = rho g S, water's weight on its area,
// and by damping, of waves that it makes. So it rings in a quarter of a second, and follows longer waves. Held are a
// few millimetres: a meniscus is no higher (Rapacchietta et al. 1977). Farther down it is flooded and rises by
// its own buoyancy; farther up it comes off.
//
// Along the surface: gravity down its slope, as the water itself has it (whose pressure at the surface is zero), and
// skin friction of laminar flow along a plate, of water below and of air above,
//   1/2 rho S C |u|^2,  C = 1.328 / sqrt(|u| L / nu)     (Blasius 1908)
// which in a steady wind U balance at ((rho_a / rho_w) sqrt(nu_a / nu_w))^(2/3) = 2.8 % of U - v, whatever the leaf.
#pragma once

#include <optional>

#include "solvers/leaves/leaf_water.h"
#include "solvers/leaves/plate_aerodynamics.h"

namespace ft::inline solvers {

/// Whether water has a leaf. In states as a number.
enum class Afloat { k_no = 0, k_floats = 1, k_under = 2 };

struct FloatingPlate {
  double stiffness = 0;                   ///< of heave [N/m]
  double mass = 0;                        ///< of heave, the water's included [kg]
  Vec3 inertia = Vec3::Zero();            ///< with the water's, plate's axes [kg m2]
  Vec3 lean = Vec3::Zero();               ///< stiffness of leaning, plate's axes [N m]; of axis 1: 0
  double reach = 0;                       ///< of the places by which it feels the water, from its middle [m]
  double lowest = 0, lowest_flipped = 0;  ///< its middle above its lowest vertex as it lies, either side up [m]
};
/// positions: of the leaf about its centre of mass, its own axes [m]; gravity [m/s2].
FloatingPlate floating_plate(const PlateModel& plate, std::span<const Vec3> positions, double gravity);

/// How the leaf moves: world axes.
struct FloatingMotion {
  Vec3 place, velocity, spin;
  Quat turn;
};

/// By how much a leaf is below the place where it would lie, kept `margin` above the water [m].
double float_depth(const FloatingPlate& floating, const WaterPatch& water, const FloatingMotion& motion, double margin);

/// Whether it is caught, flooded or lets go, as it is now. gap: of its lowest vertex above where that would lie [m];
/// lies: it touches the water, and nearly lies on it.
Afloat next_afloat(Afloat now, double depth, double gap, bool lies);

/// What is left of its motion once it has to take water along.
void enter_water(const PlateModel& plate, const FloatingPlate& floating, const WaterPatch& water,
                 FloatingMotion& motion);

/// Velocity and spin after `time` [s], for the water at its start and end; air: velocity at the leaf [m/s]; depth:
/// float_depth() at the start.
void advance_float(const PlateModel& plate, const FloatingPlate& floating, Afloat afloat, const Vec3& gravity,
                   const Vec3& air, const WaterPatch& before, const WaterPatch& after, double depth, double time,
                   FloatingMotion& motion);

/// Speed with which wind drives a floating leaf over still water, by the wind's own past it [1].
double wind_drift(const PlateModel& plate);

}  // namespace ft::inline solvers

// A rigid thin plate in moving air, quasi-steady: drag, lift of its translation, lift of its rotation, added mass. For
// leaves, which without the lift of rotation would come down like parachutes.
//
// The law is that of Andersen, Pesavento and Wang 2005 ("Unsteady aerodynamics of fluttering and tumbling plates" and
// "Analysis of transitions between fluttering, tumbling and steady descent of falling cards", J. Fluid Mech. 541) in
// their two dimensions, Kirchhoff's equations with added mass in three. What is a chord there is here, for the lift of
// translation, the direction in which the plate slides; for what rotation does, the width across the axis. A plate
// that starts in a plane stays in it and obeys their equations.
//
// Axes of a plate: 0 along its length, 1 its normal, 2 across. Caution: velocities in a PlateMotion are those of the
// plate relative to the air, in these axes.
#pragma once

#include "baker/core/types.h"

namespace ft::inline solvers {

/// Coefficients of the law [1]. As they are here those of a finite plate such as a leaf: C_D 1.2 face on, as discs and
/// squares have, and C_R and mu_1, mu_2 such that flat plates in air begin to tumble where Belmonte, Eisenberg and
/// Moses 1998 saw it, at a Froude number of 0.67.
struct PlateCoefficients {
  /// Drag: A - B cos 2 alpha, of the speed squared, along the motion. Face on A + B, edge on A - B.
  double drag_a = 0.7, drag_b = 0.5;
  double lift_translation = 1.0;  ///< C_T: lift C_T sin 2 alpha. 0: a parachute
  double lift_rotation = 1.9;     ///< C_R
  double damping_speed = 0.1;     ///< mu_1: of rotation, in proportion to the speed through the air
  double damping_spin = 0.1;      ///< mu_2: of rotation, in proportion to itself

  double face_on() const { return drag_a + drag_b; }
};

/// As measured and computed for a strip of endless span by Andersen et al.: A 1.4, B 1.0, C_T 1.2, C_R pi, mu 0.2.
PlateCoefficients strip_coefficients();

/// What never changes of a plate. All about its centre of mass, in its axes.
struct PlateModel {
  double mass = 0;                    ///< kg, > 0
  double area = 0;                    ///< m2, > 0
  Vec3 inertia = Vec3::Zero();        ///< kg m2, > 0
  Vec3 added_mass = Vec3::Zero();     ///< kg, of air of this density
  Vec3 added_inertia = Vec3::Zero();  ///< kg m2
  Vec3 half_chord = Vec3::Zero();     ///< mean half width across axes 0 and 2 [m], > 0; of 1 the mean of both
  double air_density = 1.225;         ///< kg/m3
  double fold = 0;                    ///< each of the two panels rises from the middle by this angle [rad]
  double panel_arm = 0;               ///< from the middle to a panel's centre [m]
  PlateCoefficients law;

  Vec3 masses() const { return Vec3::Constant(mass) + added_mass; }
  Vec3 inertias() const { return inertia + added_inertia; }
  /// sqrt(2 m g / (rho S C)), face on [m/s].
  double terminal_speed(double gravity) const;
};

/// Fills in added mass and added inertia. Finite: an ellipse of these mean chords; else a strip along axis 0, for as
/// much of it as there is, and `thickness` by width beside it (Lamb 1932, sections 71 and 114).
void add_air(PlateModel& plate, bool finite, double thickness_ratio = 0);

struct PlateMotion {
  Vec3 place = Vec3::Zero();     ///< of the centre of mass [m]
  Quat turn = Quat::Identity();  ///< plate to world
  Vec3 velocity = Vec3::Zero();  ///< through the air, in the plate's axes [m/s]
  Vec3 spin = Vec3::Zero();      ///< in the plate's axes [rad/s]
};

/// The air along the way of a plate, over some time.
struct PlateAir {
  Vec3 velocity = Vec3::Zero();  ///< at its start [m/s]
  Vec3 change = Vec3::Zero();    ///< m/s2
};

struct PlateForce {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< in the plate's axes [N], [N m]
};
/// Of the air, without added mass.
PlateForce plate_force(const PlateModel& plate, const Vec3& velocity, const Vec3& spin);

/// Moves a plate on by `time` [s], in as many steps as its motion asks for but no more than `most_steps`; returns how
/// many. Drag is integrated exponentially, so that a light plate in a storm is stable where the steps are too long for
/// it. Finite for whatever is finite.
int advance_plate(const PlateModel& plate, const Vec3& gravity, const PlateAir& air, double time, int most_steps,
                  PlateMotion& motion);

}  // namespace ft::inline solvers

// Ballistic flight of a free rigid body after its release. The centre of mass follows its parabola in closed form; the
// rotation is torque-free: exact for a body of equal moments of inertia, else Euler's equations by the fourth-order
// Runge-Kutta method on the body's angular momentum, in steps that follow the spin.
#pragma once

#include "baker/core/rigid.h"

namespace ft::inline solvers {

class RigidFlight {
 public:
  /// release: at time 0 of the flight. mass.inertia is positive definite; gravity [m/s2].
  RigidFlight(const RigidMotion& release, const RigidMass& mass, const Vec3& gravity = Vec3(0, -k_gravity, 0));
  /// `time` seconds after the release; negative times are before it.
  RigidMotion at(double time) const;

 private:
  RigidMotion release_;
  Vec3 gravity_;
  Mat3 inverse_inertia_;   ///< body axes
  Vec3 angular_momentum_;  ///< world axes; stays
  bool is_spherical_;
};

/// Inertia about the world's axes [kg m2].
Mat3 world_inertia(const RigidMass& mass, const Quat& rotation);
/// The rotation by a vector: its direction the axis, its length the angle [rad].
Quat rotation_by(const Vec3& vector);
/// The vector of a rotation, at most half a turn [rad].
Vec3 rotation_vector(const Quat& rotation);

}  // namespace ft::inline solvers

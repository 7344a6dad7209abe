// Two floating bodies meet, the same in all kinds of water. Plain on purpose: bodies are spheres (balls) or boxes
// filled with spheres, of which the deepest pair counts; impulses without friction, and what overlaps is moved apart.
// Approximated: boats round off to their boxes' spheres, boxes at their corners.
#pragma once

#include <limits>
#include <vector>

#include "solvers/water/water_body.h"

namespace ft::inline solvers {

/// Of bodies of which nothing else is said [1].
inline constexpr double k_float_restitution = 0.3;

struct ContactSpheres {
  std::vector<Vec3> centres;  ///< body axes [m]
  double radius = 0;          ///< m
  double reach = 0;           ///< farthest point of the body from its centre of mass [m]
};

/// Radius of a ball of the same volume where a body is one: its vertices are equally far from its centre; else 0 [m].
double ball_radius(const FloatingBody& body);
ContactSpheres contact_spheres(const FloatingBody& body);

struct Meeting {
  double depth = -std::numeric_limits<double>::infinity();  ///< m, above 0 where they overlap
  Vec3 place = Vec3::Zero(), normal = Vec3::Zero();         ///< from b to a
};
Meeting deepest(const ContactSpheres& a, const RigidPose& pose_a, const ContactSpheres& b, const RigidPose& pose_b);

/// What an impulse at a place changes of a body. added: water that goes with it without turning [kg].
struct MovedBody {
  const RigidMass* mass = nullptr;
  RigidMotion* motion = nullptr;
  double added = 0;

  Mat3 turned_inverse() const;
  double softness(const Vec3& place, const Vec3& normal) const;
  void push(const Vec3& place, const Vec3& impulse);
  double kinetic() const;
};

/// Share of the approach that comes back: none of slow ones.
double bounce_of(double approach, double restitution);

/// Moves two that overlap apart, and turns their velocities where they approach; what energy that costs [J].
double meet(MovedBody a, const ContactSpheres& spheres_a, MovedBody b, const ContactSpheres& spheres_b,
            double restitution);

}  // namespace ft::inline solvers

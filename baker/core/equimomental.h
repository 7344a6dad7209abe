// A rigid body as four equal point masses: the tetrahedron that has the body's mass, centre and inertia (equimomental
// system; Routh 1905, art. 38). Its surface are fixed affine combinations of the four, so that a straight way of the
// four is a straight way of every point, which keeps continuous collision exact (affine body dynamics: Lan et al.
// 2022); six stiff springs keep the tetrahedron in shape.
#pragma once

#include <array>
#include <span>

#include "baker/core/mesh.h"
#include "baker/core/rigid.h"

namespace ft {

struct Equimomental {
  std::array<Vec3, 4> node;  ///< body axes, about the centre of mass [m]; each carries a quarter of the mass

  /// Weights that make a point of the body from the nodes; they sum to 1.
  std::array<double, 4> weights(const Vec3& in_body) const;
  /// The pose that has these nodes, in the sense of least squares.
  RigidPose pose(std::span<const Vec3, 4> nodes) const;
  std::array<Vec3, 4> place(const RigidPose& pose) const;
  /// Linear and angular velocity of four points that move as a rigid body.
  RigidMotion motion(std::span<const Vec3, 4> nodes, std::span<const Vec3, 4> velocities) const;
};

/// A body whose inertia is that of no body (a principal moment larger than the sum of the others) counts as flat there.
Equimomental equimomental(const RigidMass& mass);

/// What a rigid body of this surface weighs where: filled evenly, or only its skin. Centre of mass first [m].
struct BodyMass {
  Vec3 centre = Vec3::Zero();
  RigidMass mass;
};
BodyMass filled_mass(std::span<const Vec3> positions, std::span<const Triangle> triangles, double kilograms);
BodyMass hollow_mass(std::span<const Vec3> positions, std::span<const Triangle> triangles, double kilograms);

}  // namespace ft

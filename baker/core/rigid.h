// A rigid body's place, motion and mass, about its centre of mass.
#pragma once

#include <span>

#include "baker/core/types.h"

namespace ft {

struct RigidPose {
  Vec3 position = Vec3::Zero();      ///< of the centre of mass [m]
  Quat rotation = Quat::Identity();  ///< body to world

  Vec3 operator*(const Vec3& in_body) const { return position + rotation * in_body; }
};

struct RigidMotion {
  RigidPose pose;
  Vec3 velocity = Vec3::Zero();  ///< of the centre of mass [m/s]
  Vec3 spin = Vec3::Zero();      ///< angular velocity, world axes [rad/s]

  Vec3 velocity_at(const Vec3& place) const { return velocity + spin.cross(place - pose.position); }
};

struct RigidMass {
  double mass = 0;              ///< kg
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, body axes [kg m2]
};

/// The rotation nearest to a matrix, by least squares.
Mat3 nearest_rotation(const Mat3& m);

/// The rigid motion that takes `from` nearest to `to`, by least squares (Kabsch 1976). As many points in both.
Eigen::Isometry3d rigid_fit(std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace ft

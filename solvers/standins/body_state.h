// The body that stand-ins act on, at one instant: how it moves, and a few points that say where its surface and its
// volume are.
#pragma once

#include <span>
#include <vector>

#include "baker/core/rigid.h"

namespace ft::inline solvers {

/// A piece of the body. Pieces of its surface have an area, pieces of its inside a volume; a piece may have both.
struct ShapeSample {
  Vec3 place = Vec3::Zero();     ///< from the centre of mass, body axes [m]
  Vec3 normal = Vec3::Zero();    ///< of the surface, outwards, unit; zero for a piece of the inside
  double area = 0;               ///< m2
  double volume = 0;             ///< m3
  Vec3 velocity = Vec3::Zero();  ///< against the body's axes [m/s]; not zero where limbs move
};

struct BodyState {
  RigidMotion motion;
  Vec3 acceleration = Vec3::Zero();    ///< of the centre of mass [m/s2]
  Vec3 spin_rate = Vec3::Zero();       ///< angular acceleration, world axes [rad/s2]
  double mass = 0;                     ///< kg
  std::span<const ShapeSample> shape;  ///< empty: a point
  double time = 0;                     ///< s from the first frame of the shot

  /// From the centre of mass to a sample, world axes [m].
  Vec3 arm(const ShapeSample& sample) const { return motion.pose.rotation * sample.place; }
  /// Of a sample that is at this arm [m/s].
  Vec3 velocity(const ShapeSample& sample, const Vec3& arm) const {
    return motion.velocity + motion.spin.cross(arm) + motion.pose.rotation * sample.velocity;
  }
};

/// A ball of equal pieces of volume, about `across` of them along the diameter, and as many pieces of surface as the
/// square of that. radius [m] > 0, across >= 1.
std::vector<ShapeSample> sphere_shape(double radius, int across = 8);
/// A box of size [m], sampled alike: `across` pieces along each side.
std::vector<ShapeSample> box_shape(const Vec3& size, int across = 8);
/// The surface of a mesh whose vertices are given from the centre of mass, one sample for each triangle.
std::vector<ShapeSample> surface_shape(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft::inline solvers

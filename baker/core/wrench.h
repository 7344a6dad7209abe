// A force and its torque: what a secondary does to its primary, or a stand-in to a body.
#pragma once

#include "baker/core/types.h"

namespace ft {

struct Wrench {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 torque = Vec3::Zero();  ///< about a point that is said where it is kept [N m]

  /// A force at an arm from that point [m].
  void add(const Vec3& arm, const Vec3& at_arm) {
    force += at_arm;
    torque += arm.cross(at_arm);
  }
  Wrench& operator+=(const Wrench& other) {
    force += other.force;
    torque += other.torque;
    return *this;
  }
  /// The same wrench about a point that lies `to` away from the one before [m].
  Wrench moved(const Vec3& to) const { return {force, torque - to.cross(force)}; }
};
inline Wrench operator*(double factor, const Wrench& w) {
  return {factor * w.force, factor * w.torque};
}

}  // namespace ft

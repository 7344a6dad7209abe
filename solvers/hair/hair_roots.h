// Roots ride on a triangle of the scalp each: a place in it, and a frame that turns with it.
#pragma once

#include <span>
#include <vector>

#include "solvers/hair/hair_setup.h"

namespace ft::inline solvers {

/// Rotation and place of a root.
struct RootFrame {
  Vec3 place = Vec3::Zero();
  Mat3 turn = Mat3::Identity();
  Vec3 carry(const RootFrame& before, const Vec3& point) const {
    return place + turn * (before.turn.transpose() * (point - before.place));
  }
};

class HairRoots {
 public:
  /// roots: in the bind pose [m].
  HairRoots(const Trajectory& scalp, std::span<const Vec3> roots);
  /// Of all roots, for a pose of the scalp's vertices.
  void frames(std::span<const Vec3> scalp, std::vector<RootFrame>& out) const;
  /// In the bind pose.
  std::span<const RootFrame> bind() const { return bind_; }
  /// How far the farthest root was from the scalp [m].
  double farthest() const { return farthest_; }

 private:
  struct Root {
    Triangle corners;
    Vec3 weights, off;  ///< off: from the triangle's place to the root, in the triangle's frame [m]
  };
  std::vector<Root> roots_;
  std::vector<RootFrame> bind_;
  double farthest_ = 0;
};

}  // namespace ft::inline solvers

// Keeps points outside of a body.
#pragma once

#include <span>

#include "baker/core/types.h"
#include "collision/geometry/triangle_tree.h"
#include "collision/geometry/winding_number.h"

namespace ft::inline baker {

class Outside {
 public:
  /// Of a surface that faces outwards and has triangles; it has to stay.
  Outside(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  Outside(const Outside&) = delete;

  struct Push {
    Vec3 place = Vec3::Zero();   ///< m
    Vec3 normal = Vec3::Zero();  ///< along which it was pushed, or zero where it was far enough away
  };
  /// The place, or the nearest one that is outside and `gap` [m] away from the surface, as far as a few pushes find it.
  Push out(const Vec3& place, double gap) const;
  bool is_inside(const Vec3& place) const;

 private:
  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
  TriangleTree tree_;
  WindingTree winding_;
};

}  // namespace ft::inline baker

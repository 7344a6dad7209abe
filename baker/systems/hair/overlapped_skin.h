// Places where a body overlaps itself, such as the fold between a raised arm and the neck: what is there is outside of
// the skin that is nearest to it and inside of another part of the same body. It has nowhere to go.
#pragma once

#include <span>

#include "baker/core/mesh.h"
#include "collision/body/part_distance.h"
#include "collision/geometry/triangle_tree.h"

namespace ft::inline baker {

class OverlappedSkin {
 public:
  /// rest: a pose in which skin that is to be seen lies open [m].
  OverlappedSkin(std::span<const Vec3> rest, std::span<const Triangle> triangles);

  /// Of a point that is inside of a body whose triangles have a tree, in the pose x: whether it is outside of the skin
  /// that is nearest, which lay open at rest. Eyes in their sockets never did.
  bool holds(const Vec3& point, const TriangleTree& tree, std::span<const Vec3> x) const;

 private:
  std::vector<Vec3> rest_;
  std::vector<Triangle> triangles_;
  PartSurface surface_;
  TriangleTree tree_;  ///< at rest
};

}  // namespace ft::inline baker

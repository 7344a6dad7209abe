// The tree leaves around a small cluster of points, laid out so that a point's distances to all their boxes are one
// loop of eight at a time. For the feasible collider, which asks for the closest triangle of some thousand points that
// come in clusters.
#pragma once

#include <vector>

#include "collision/triangle_tree.h"

namespace ft {

class NearbyLeaves {
 public:
  /// Forgets all leaves. centre: of the points that will be asked for; boxes are kept relative to it, in single
  /// precision.
  void begin(const Vec3& centre);
  void add(const TriangleTree& tree, const TriangleTree::Node& leaf);
  /// The closest triangle of all leaves no farther than reach [m]; ties go to the lowest triangle.
  TriangleTree::Hit closest(const Vec3& p, double reach, std::span<const Vec3> positions,
                            std::span<const Triangle> triangles);

 private:
  Vec3 centre_ = Vec3::Zero();
  std::vector<float> lo_[3], hi_[3];
  std::vector<float> distance2_;
  std::vector<std::pair<const TriangleTree*, const TriangleTree::Node*>> leaves_;
};

}  // namespace ft

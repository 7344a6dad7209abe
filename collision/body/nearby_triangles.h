// The triangles around a small cluster of points, their boxes laid out so that a point's distances to all of them are
// one loop of eight at a time. For the feasible collider, which asks for the closest triangle of some thousand points
// that come in clusters.
#pragma once

#include <vector>

#include "collision/geometry/triangle_tree.h"

namespace ft::inline collision {

class NearbyTriangles {
 public:
  /// Takes up the triangles of trees whose boxes meet a box, which holds the points that will be asked for with their
  /// reach. Forgets all others.
  void begin(const TreeBox& around);
  void add(const TriangleTree& tree, std::span<const Vec3> positions, std::span<const Triangle> triangles);
  /// The closest of them no farther than reach [m]; ties go to the lowest triangle.
  TriangleTree::Hit closest(const Vec3& p, double reach, std::span<const Vec3> positions,
                            std::span<const Triangle> triangles);

 private:
  static constexpr std::size_t k_lanes = 8;
  using Lanes = float __attribute__((vector_size(4 * k_lanes)));
  /// The last ones are filled up with some that are far from everything.
  struct Boxes {
    Lanes lo[3], hi[3];
  };

  TreeBox around_{};
  Vec3 centre_ = Vec3::Zero();  ///< boxes are kept relative to it, in single precision
  std::vector<Boxes> boxes_;
  std::vector<Lanes> distance2_;
  std::vector<int> triangle_;
};

}  // namespace ft::inline collision

// A surface that is checked frame after frame, for crossings.h and penetration.h: what follows from its triangles alone
// is found once, its box tree is built at the first place and refitted afterwards. Results do not depend on the tree.
#pragma once

#include <span>
#include <vector>

#include "collision/geometry/triangle_tree.h"

namespace ft::inline collision {

class CheckedSurface {
 public:
  /// Of triangles that stay where they are.
  explicit CheckedSurface(std::span<const Triangle> triangles);
  /// Takes the surface to positions [m], which have to stay alive until the next move.
  void move(std::span<const Vec3> positions);
  /// Frees what move() makes anew.
  void forget_boxes() { tree_.forget_boxes(); }

  bool empty() const { return triangles_.empty(); }
  /// Whether every edge is passed once in either direction: it has an inside, and none gets there without a crossing.
  bool closed() const { return closed_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  std::span<const Vec3> positions() const { return positions_; }
  const TriangleTree& tree() const { return tree_; }
  /// Bit k: edge k (of corners k and k + 1) belongs to this triangle. Every edge belongs to exactly one.
  unsigned char owned_edges(int triangle) const { return owned_[static_cast<std::size_t>(triangle)]; }

 private:
  std::span<const Triangle> triangles_;
  std::vector<unsigned char> owned_;
  bool closed_ = true;
  std::span<const Vec3> positions_;
  TriangleTree tree_;
};

}  // namespace ft::inline collision

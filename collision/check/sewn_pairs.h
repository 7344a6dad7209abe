// Which vertices a seam holds at one place, or next to each other: pairs of surface elements that have them on both
// sides are neighbours, as if they shared a vertex, and neither repel nor count as crossing. For contact, certificate
// and `check`. Reach: what is sewn together directly, what is sewn to the same point (three panels in a corner), and
// one step along the seam, because the two sides of a seam need not have the same number of vertices.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "collision/check/crossings.h"

namespace ft::inline collision {

class SewnPairs {
 public:
  SewnPairs() = default;  ///< nothing is sewn
  SewnPairs(int vertex_count, std::span<const Stitch> stitches, std::span<const Triangle> triangles);

  bool empty() const { return near_.items.empty(); }
  /// True when a vertex of `a` is sewn next to a vertex of `b`. Indices beyond the vertex count belong to nothing sewn.
  bool together(std::span<const int> a, std::span<const int> b) const;
  bool together(const Crossing& crossing) const { return together(crossing.edge, crossing.triangle); }

 private:
  Adjacency near_;
};

}  // namespace ft::inline collision

// Edges of a body over which a segment of a strand can cut although both its ends are outside: ridges, as of an ear,
// and of sheets all, because a sheet folds anywhere.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/core/types.h"
#include "solvers/hair/moving_tree.h"

namespace ft::inline solvers {

class SharpEdges {
 public:
  SharpEdges() = default;
  /// Of a body in its bind pose, for segments of a length [m]. all: of a sheet.
  SharpEdges(std::span<const Vec3> bind, std::span<const Triangle> triangles, double length, bool all);

  MovingTree& tree() { return tree_; }
  /// Calls visit(triangle, k) for the sharp edges, from corner k to the next, of triangles that can come within reach
  /// of a box (MovingTree). An edge belongs to one of its triangles.
  template <class Visit>
  void for_each_within(const Vec3& lo, const Vec3& hi, double reach, Visit&& visit) const {
    tree_.for_each_within(lo, hi, reach, [&](int t) {
      for (int k = 0; k < 3; ++k)
        if (sharp_[at(t)] & (1 << k)) visit(t, k);
    });
  }

 private:
  MovingTree tree_;                  ///< over triangles with a sharp edge
  std::vector<std::uint8_t> sharp_;  ///< of each triangle: bit k of its edge k
};

}  // namespace ft::inline solvers

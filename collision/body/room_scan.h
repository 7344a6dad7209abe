// Where a pose leaves no room for cloth: pairs of body parts that overlap or come nearer to each other than the gap
// that the feasible collider keeps. Jointed parts, which fold into each other at every bent knee, are not counted. For
// a look at the whole clip before the bake: there the cloth will lie on a collider that is not the drawn body. Measured
// on the drawn pose, at the vertices that the feasible collider has to move. Thread-safe; deterministic.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "collision/body/feasible_poses.h"

namespace ft::inline collision {

/// Part `a` gives way to part `b`.
struct TightPlace {
  int part_a = -1, part_b = -1;
  double clearance = 0;       ///< smallest distance of a's vertices to b [m]; negative: a is inside b so deep
  Vec3 place = Vec3::Zero();  ///< of that vertex as drawn [m]
};

class RoomScanner {
 public:
  /// The poses that it has looked at are kept there.
  explicit RoomScanner(std::shared_ptr<FeasiblePoses> poses);
  ~RoomScanner();
  /// Pairs nearer than the gap at this time [s], by parts. absent_share, per part, or empty: not asked for: of its
  /// vertices in the collider those that are absent then (absent_vertices.h), 0..1.
  std::vector<TightPlace> look(double time, std::span<double> absent_share = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ft::inline collision

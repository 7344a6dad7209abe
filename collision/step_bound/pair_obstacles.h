// Pairs that are in the way of a displacement: it would bring them nearer than one step may, whatever plane proves it.
// Where truncation (truncate_dat.h) leaves next to nothing of a displacement, these are why.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/broad_phase/pair_view.h"

namespace ft::inline collision {

/// sum weight[i] * x[i] is the offset between the pair's closest points or, where these keep apart, between the
/// vertices of either feature that come nearest.
struct PairObstacle {
  std::array<int, 4> vertex;
  std::array<double, 4> weight;  ///< positive of the first feature, negative of the second
  Vec3 normal;                   ///< from the second feature to the first
  double approach;               ///< of the two along the normal [m]
  double allowed;                ///< of it, at least the floor [m]
};

/// Those of displacements dx [m], in the order of the pairs. Vertices at or past movable_count do not move; x holds
/// them too, dx need only hold the movable ones. floor: what pairs keep from each other [m].
std::vector<PairObstacle> find_obstacles(std::span<const Vec3> x, std::span<const Vec3> dx, int movable_count,
                                         const PairView& pairs, double floor);

}  // namespace ft::inline collision

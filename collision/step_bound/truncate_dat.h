// "Divide and truncate" (Chen et al. 2025, "Offset Geometric Contact", planar form): the space between the closest
// points of every pair is divided by two planes, and each vertex may use most of its own distance to its plane. A step
// that is taken with the shares below leaves every pair separated, whatever the others do, so a crossing-free state
// stays crossing-free.
//
// The planes move: what the vertices of a pair have in common (common_motion.h) carries them along, and only the rest
// of a displacement is truncated. With planes that stand still a mesh whose edges are shorter than its displacements
// would be held fast by its own neighbourhood.
//
// Caution: the proof covers the listed pairs only. The list must hold every pair that can meet in the step; see
// contact_pairs.h.
#pragma once

#include <span>

#include "collision/broad_phase/pair_view.h"
#include "collision/step_bound/pair_room.h"

namespace ft::inline collision {

/// For every vertex the largest share in [0, 1] of dx - common [m] so that common + share * (dx - common) brings no
/// pair nearer than floor [m] (or than it is, where it is already nearer). No pair may be too near for `common` alone,
/// which is zero or CommonMotion's. Vertices at or past movable_count do not move; x holds them too, the others need
/// only hold the movable ones. Pairs that touch allow no motion. The order of pairs does not matter.
void truncate_displacements(std::span<const Vec3> x, std::span<const Vec3> dx, std::span<const Vec3> common,
                            int movable_count, const PairView& pairs, double floor, std::span<double> share);

/// The shares of one pair alone; a vertex that is not movable gets 1.
std::array<double, 4> truncate_pair(PairKind kind, const PairMove& move, double floor);

}  // namespace ft::inline collision

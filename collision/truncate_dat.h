// "Divide and truncate" (Chen et al. 2025, "Offset Geometric Contact", planar form): the space between the closest
// points of every pair is divided by two planes, and each vertex may use most of its own distance to its plane. A step
// that is taken with the shares below leaves every pair separated, whatever the others do, so a crossing-free state
// stays crossing-free.
//
// Caution: the proof covers the listed pairs only. The list must hold every pair that can meet in the step; see
// contact_pairs.h.
#pragma once

#include <span>

#include "collision/contact_pairs.h"
#include "collision/pair_geometry.h"

namespace ft {

/// Share of the way to its plane that a vertex may use [1]. The rest keeps the next step possible.
inline constexpr double k_truncate_reach = 0.9;

/// For every vertex the largest share in [0, 1] of its displacement dx [m] so that no pair can come nearer than floor
/// [m] (or than it is, where it is already nearer). Vertices at or past movable_count do not move; x holds them too, dx
/// and share need only hold the movable ones. Pairs that touch allow no motion. The order of pairs does not matter.
void truncate_displacements(std::span<const Vec3> x, std::span<const Vec3> dx, int movable_count,
                            const ContactPairs& pairs, double floor, std::span<double> share);

/// The shares of one pair alone; a vertex with movable[i] false gets 1 and counts as still.
std::array<double, 4> truncate_pair(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& dx,
                                    const std::array<bool, 4>& movable, double floor);

}  // namespace ft

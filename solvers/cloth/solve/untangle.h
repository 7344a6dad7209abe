// The way out of a tangle: where an edge crosses a face, both are pushed so that the line in which the surfaces cut
// each other gets shorter. Volino and Magnenat-Thalmann, "Resolving Surface Collisions through Intersection Contour
// Minimization" (2006). It needs no notion of inside and works for open sheets; a garment whose rest shape crosses
// itself keeps what its fabric insists on.
#pragma once

#include <span>
#include <vector>

#include "collision/check/crossings.h"

namespace ft::inline solvers {

/// Accelerations [m/s2] for all vertices that shorten the contours of these crossings (of crossings_within); zero
/// elsewhere.
void untangling(std::span<const Vec3> x, std::span<const Triangle> triangles, std::span<const Crossing> crossings,
                std::span<Vec3> acceleration);

}  // namespace ft::inline solvers

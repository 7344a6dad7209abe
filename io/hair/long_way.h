// How far along its long way each vertex of a piece of a hair mesh is.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

/// From 0 at one end to 1 at the other, for each vertex of one connected piece; lines of equal values cross a strip or
/// go round a tube. Empty for what has no area. Of what is as wide as long,
/// and of rings, the values mean little: look at the slices.
std::vector<double> long_way(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft::inline io

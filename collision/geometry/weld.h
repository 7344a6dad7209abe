// Which vertices of a surface are one: files split a vertex where normals or texture coordinates jump.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline collision {

/// Per vertex the first of those that have the same place in the bind pose, bit for bit, and the same part.
std::vector<int> weld(std::span<const Vec3> bind, std::span<const int> part_of_vertex);

}  // namespace ft::inline collision

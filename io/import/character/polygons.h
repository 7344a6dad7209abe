// Polygons of any number of corners as triangles, also where they are bent inwards or not flat.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

/// Largest polygon that is cut ear by ear; larger ones become a fan from their first corner.
inline constexpr std::size_t k_max_ear_corners = 1024;

/// Appends corner count - 2 triangles that go round as the polygon does, of three corners or more. A quad is split by
/// the shorter diagonal that lies inside it (the one from the first corner where both are as long); a larger polygon by
/// cutting ears in its plane (Newell's normal). One that crosses itself still gives that many triangles.
void split_polygon(std::span<const int> corners, std::span<const Vec3> positions, std::vector<Triangle>& out);

}  // namespace ft::inline io

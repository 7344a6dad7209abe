// Caps: triangles one corner of which lies so near the middle part of the longest edge that its height h is less than
// s = 1/50 of that edge's length L. They are next to no cloth, but a spring of stiffness 1/h, and a hinge whose angle
// turns by 1 while that corner moves by h: neither is right for more than h, and Newton's method comes to no end.
//
// Where the triangle beyond the longest edge lies in the same piece of cloth, the two are therefore parted by their
// other diagonal, as a Delaunay triangulation would, for elasticity, mass and air; contact and everything else goes by
// the triangles as they are drawn. What is left of caps, at free edges and seams, is softened.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "solvers/energies/cloth_topology.h"

namespace ft::inline solvers {

/// Share of its stiffness that a triangle keeps [1], from its area [m2] and ClothTopology::rest_inverse: 1 unless it is
/// a cap; then (h / s L)^2. With the share it is as soft across as a strip of cloth that is s^2 L^2 / h wide, for h =
/// L/2000 that is still less than an edge. Triangles with one very short edge keep all: their corners hang together.
double cap_stiffness(double rest_area, const std::array<double, 4>& rest_inverse);

/// Parts caps and what lies beyond their longest edge anew, where no cap and no needle comes of the two; appends to
/// ClothTopology::flipped_caps. uvs: of the corners of each triangle, or empty. measure(triangle) fills rest_inverse
/// and rest_area of a triangle; they have to be filled.
void flip_caps(ClothTopology& topology, std::vector<std::array<Vec2, 3>>& uvs,
               const std::function<void(std::size_t)>& measure);

}  // namespace ft::inline solvers

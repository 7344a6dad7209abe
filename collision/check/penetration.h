// How deep points are inside a drawn surface: for garments that start inside the body, for reports and for judging a
// bake. Inside is where the generalized winding number w is above 1/2, or below -1/2 (winding_number.h). Of a closed
// surface it is whole and three rays tell, the majority wins: 1 in one shell, 2 where two overlap, 0 in a mouth that is
// a shell of its own and faces into its air, -1 in a body that is inside out, whose garments are no less inside. Of
// open shells (cards of hair, eyes, sleeves) rays tell nothing, for one that leaves through a dome may have come from
// anywhere below it; w does: it is above 1/2 up to about where a lid would be, so that a body without a few triangles
// still has an inside, and a card has none. Depth is the distance to the nearest triangle, whichever part of the body
// that is.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"
#include "collision/check/checked_surface.h"
#include "collision/check/crossings.h"

namespace ft::inline collision {

struct Penetration {
  int vertex = -1;   ///< index into points
  double depth = 0;  ///< distance to the surface [m]
};

/// Whether a point near a surface's triangles is inside, as of a closed surface: where a wrong answer at the rim of an
/// open shell does no harm. tree is of these triangles, refitted to these positions [m].
bool rays_say_inside(const Vec3& p, const TriangleTree& tree, std::span<const Vec3> surface,
                     std::span<const Triangle> triangles);

/// Points inside by more than least_depth [m], by ascending vertex. Triangles counter-clockwise seen from outside.
std::vector<Penetration> penetrations(std::span<const Vec3> points, const CheckedSurface& surface,
                                      double least_depth = 1e-5);
std::vector<Penetration> penetrations(std::span<const Vec3> points, std::span<const Vec3> surface,
                                      std::span<const Triangle> triangles, double least_depth = 1e-5);

/// The same for points of a mesh with these edges, when the crossings of a surface over it (first, crossings.h) with
/// `surface` are known: points that are joined by edges without a crossing are all inside a closed surface or all
/// outside, so that one of them tells. Of a surface that is not closed every point is asked.
std::vector<Penetration> penetrations(std::span<const Vec3> points, std::span<const Edge> edges,
                                      std::span<const Crossing> crossings, const CheckedSurface& surface,
                                      double least_depth = 1e-5);

}  // namespace ft::inline collision

// How deep points are inside a drawn surface: for garments that start inside the body, for reports and for judging a
// bake. Inside is decided by the winding along three rays, the majority wins, so that a slightly open mesh (a missing
// cap, a neck hole) still has an inside; depth is the distance to the nearest triangle, whichever part of the body that
// is.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"
#include "collision/checked_surface.h"
#include "collision/crossings.h"

namespace ft {

struct Penetration {
  int vertex = -1;   ///< index into points
  double depth = 0;  ///< distance to the surface [m]
};

/// Whether a point is inside: tree is of these triangles, refitted to these positions [m].
bool is_inside(const Vec3& p, std::span<const Vec3> surface, std::span<const Triangle> triangles,
               const TriangleTree& tree);

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

}  // namespace ft

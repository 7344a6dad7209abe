// Plain closed surfaces about the origin, outwards counter-clockwise.
#pragma once

#include "baker/core/mesh.h"

namespace ft {

struct TriangleSurface {
  std::vector<Vec3> positions;  ///< m
  std::vector<Triangle> triangles;
};

/// An octahedron whose triangles are halved `levels` times, on a sphere: 8 * 4^levels triangles.
TriangleSurface sphere_surface(double radius, int levels);
/// size: whole lengths along x, y, z [m].
TriangleSurface box_surface(const Vec3& size);
/// A sphere drawn out along y: its two halves' centres `length` apart [m].
TriangleSurface capsule_surface(double radius, double length, int levels);

}  // namespace ft

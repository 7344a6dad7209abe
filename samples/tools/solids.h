// Plain closed solids of which the samples' sets are built: boxes with bevelled edges, round rods. Each is a piece of
// its own in the mesh it is added to. For make_set.
#pragma once

#include <Eigen/Geometry>

#include "baker/core/mesh.h"

namespace ft::sets {

/// About the origin. `bevel` [m] is cut off all edges; less than half of the smallest size.
Mesh bevelled_box(const Vec3& size, double bevel);

/// Along y, about the origin, with `sides` corners around.
Mesh rod(double length, double radius, int sides);

/// Takes y to the way from `from` to `to`, and the origin to its middle.
Eigen::Isometry3d between(const Vec3& from, const Vec3& to);

void add(Mesh& to, const Mesh& solid, const Eigen::Isometry3d& place);

}  // namespace ft::sets

// Is a garment ready to wear: nothing of it inside the body or through it, its triangles well shaped? For
// make_garments.
#pragma once

#include <span>

#include "baker/core/mesh.h"
#include "samples/tools/body_slices.h"

namespace ft::garments {

/// Edges of either that pass through a triangle of the other. Exact up to rounding; every pair near in a grid is looked
/// at.
int count_crossings(std::span<const Vec3> a, std::span<const Triangle> a_triangles, std::span<const Vec3> b,
                    std::span<const Triangle> b_triangles);

struct ShapeQuality {
  double shortest_edge = 0, median_edge = 0, longest_edge = 0;  ///< m
  double smallest_angle_deg = 0, angle_deg_p1 = 0;              ///< of all corners; the first percentile
};
ShapeQuality shape_quality(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft::garments

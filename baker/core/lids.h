// What would close an open surface: over each of its rims a fan of triangles about the rim's middle. Edges of a mesh
// that its triangles run along as often in one direction as in the other are closed; the rest makes closed curves
// whatever the mesh is like, with edges of many triangles and Moebius strips, so that with the fans every point has a
// whole winding number.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"

namespace ft {

/// Per vertex: the first of those in the same place.
std::vector<int> first_in_place(std::span<const Vec3> positions);

struct Lids {
  std::vector<Vec3> middles;         ///< one of each rim; numbered on after the surface's vertices
  std::vector<Triangle> triangles;   ///< of surface vertices and middles
  double area = 0;                   ///< m2
  double surface_area = 0;           ///< of the surface without them [m2]
  double edges = 0, open_edges = 0;  ///< of the surface

  /// Of the surface's area.
  double share() const { return surface_area > 0 ? area / surface_area : 0; }
};

/// Vertices in the same place count as one, so that a seam is no rim.
Lids close_rims(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft

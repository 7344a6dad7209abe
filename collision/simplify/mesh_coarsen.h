// A coarser mesh over some of the vertices of a surface, for previews: edges are collapsed, the shortest first, until
// they are as long as wanted everywhere. The outline, seams of the pattern and groups of vertices keep their shape, and
// every vertex of the finer mesh gets a place on the coarser one. What decides is the shape of the triangles at rest,
// not curvature, since flat cloth has to bend anywhere; a body is lifted after it (coarse_body.h). After Hoppe et al.
// 1993, "Mesh optimization" (collapses that keep the topology), without the optimization.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"
#include "collision/simplify/mesh_collapse.h"

namespace ft::inline collision {

inline constexpr int k_group_stays = -1;

struct CoarsenInput {
  std::span<const Vec3> rest;  ///< m
  std::span<const Triangle> triangles;
  std::span<const std::array<Vec2, 3>> uvs;  ///< of the corners of each triangle, or empty
  /// Per vertex, or empty. 0: free. A vertex of a group above 0 is only drawn into one of its group; k_group_stays
  /// stays.
  std::span<const int> group;
  double factor = 2;  ///< edges get this many times as long, 1..4; a quarter of the vertices are left at 2
  double longest = std::numeric_limits<double>::infinity();  ///< no edge is wanted longer than this [m]
  /// A collapse may not leave its vertex, with what was drawn into that before (their distances are summed), farther
  /// off the triangles that take its place [m]. What was drawn into their other corners is not looked at again.
  double deviation = std::numeric_limits<double>::infinity();
  bool cut = false;  ///< the uvs are a pattern: no triangle turns over or gets thin there either
};

/// Depends on the input alone. Where nothing may be collapsed (degenerate or branching surfaces) the mesh stays as it
/// is.
CoarsenedMesh coarsen_mesh(const CoarsenInput& input);

}  // namespace ft::inline collision

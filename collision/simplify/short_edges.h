// Edges that are absurdly short are collapsed: what a knife, a boolean or a decimation left behind. A solver has
// nothing to win from vertices that nobody sees part, and much to lose. Everything else stays as it is, bit for bit.
// Topology, seams of the pattern and the way that triangles face are kept, and none gets much thinner than it was;
// where that cannot be, an edge stays short. After Hoppe et al. 1993, as mesh_coarsen.h, whose collapses want good
// triangles.
#pragma once

#include "collision/simplify/mesh_collapse.h"

namespace ft::inline collision {

struct ShortEdgesInput {
  std::span<const Vec3> rest;  ///< m
  std::span<const Triangle> triangles;
  std::span<const std::array<Vec2, 3>> uvs;  ///< of the corners of each triangle, or empty
  double shortest = 0;                       ///< no edge should be shorter [m]
  double pattern_scale = 0;                  ///< above 0: m per unit of the uvs, in which an edge has to be short, too
  std::span<const char> held;  ///< per vertex, or empty: what pins or seams hold is rather drawn to than drawn [0, 1]
};

/// Whether there is any edge to collapse.
bool has_short_edges(const ShortEdgesInput& input);

/// Depends on the input alone.
CoarsenedMesh collapse_short_edges(const ShortEdgesInput& input);

}  // namespace ft::inline collision

// Splits long edges of a triangle surface at their middles, conformally, so that a body's long triangles can give way near cloth.
// For the feasible collider. Every new vertex is the mean of two earlier ones, so a new pose costs one pass; an edge's split is
// decided by its length alone, so surfaces whose seams are not welded stay without cracks.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft {

struct RefinedMesh {
  int drawn_vertex_count = 0;
  std::vector<std::array<int, 2>> parents;  ///< of vertex drawn_vertex_count + i: both earlier
  std::vector<Triangle> triangles;          ///< refined, in the order of the triangles that they came from
  std::vector<int> source;                  ///< triangle of the unrefined surface, per refined triangle

  int vertex_count() const { return drawn_vertex_count + static_cast<int>(parents.size()); }
  /// Positions of all vertices; the first drawn_vertex_count are the drawn ones, bit for bit.
  void positions(std::span<const Vec3> drawn, std::span<Vec3> refined) const;
};

/// Edges longer than max_edge [m] in the given pose are halved until none is left, or until another round would give more than
/// max_triangles (a hall's floor must not eat the memory).
RefinedMesh refine_mesh(std::span<const Vec3> pose, std::span<const Triangle> triangles, double max_edge,
                        std::size_t max_triangles = 400'000);

}  // namespace ft

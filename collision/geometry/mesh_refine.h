// Splits long edges of a triangle surface, conformally, so that a body's long triangles can give way near cloth. For
// the feasible collider. Every new vertex is a fixed blend of two earlier ones, so a new pose costs one pass. Where an
// edge is split follows from its ends' positions alone, so surfaces whose seams are not welded stay without cracks.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft::inline collision {

struct RefinedMesh {
  struct Blend {
    int a, b;      ///< earlier vertices
    double share;  ///< of b [0, 1]
  };
  int drawn_vertex_count = 0;
  std::vector<Blend> blends;        ///< of vertex drawn_vertex_count + i
  std::vector<Triangle> triangles;  ///< refined, in the order of the triangles that they came from
  std::vector<int> source;          ///< triangle of the unrefined surface, per refined triangle

  int vertex_count() const { return drawn_vertex_count + static_cast<int>(blends.size()); }
  /// Positions of all vertices; the first drawn_vertex_count are the drawn ones, bit for bit.
  void positions(std::span<const Vec3> drawn, std::span<Vec3> refined) const;
};

/// Edges longer than max_edge [m] in the given pose are split until none is left, or until another round would give
/// more than max_triangles (a hall's floor must not eat the memory). whole, per triangle or empty: these, which share
/// no edge with others, are not split.
RefinedMesh refine_mesh(std::span<const Vec3> pose, std::span<const Triangle> triangles, double max_edge,
                        std::size_t max_triangles = 400'000, std::span<const char> whole = {});

}  // namespace ft::inline collision

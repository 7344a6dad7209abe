// What the retreat of a pair (pair_retreat() in pair_room.h) does to clusters of vertices.
#pragma once

#include <array>
#include <cmath>

#include "collision/broad_phase/contact_pairs.h"
#include "collision/geometry/pair_geometry.h"
#include "collision/step_bound/vertex_clusters.h"

namespace ft::inline collision {

/// Calls change(vertex, retreat) with how far each vertex is moved along the pair's normal [m], if its corners are to
/// be moved by `along`. What a corner is moved by all of its cluster is: once, by the largest, where several corners
/// are in it. But for a cluster that both features have vertices of: it cannot part from itself as one.
template <class Change>
void for_each_retreat(const VertexClusters& clusters, PairKind kind, const Stencil& stencil,
                      const std::array<double, 4>& along, const Change& change) {
  const auto split = static_cast<std::size_t>(first_feature_size(kind));
  for (std::size_t i = 0; i < 4; ++i) {
    if (along[i] == 0) continue;
    const int cluster = clusters.of(stencil.v[i]);
    bool alone = cluster < 0, largest = true;
    for (std::size_t k = 0; k < 4 && !alone; ++k) {
      if (k == i || clusters.of(stencil.v[k]) != cluster) continue;
      const double own = std::abs(along[i]), other = std::abs(along[k]);
      alone = (k < split) != (i < split);
      largest = largest && (own > other || (own == other && i < k));
    }
    if (alone)
      change(stencil.v[i], along[i]);
    else if (largest)
      for (const int v : clusters.members(cluster)) change(v, along[i]);
  }
}

}  // namespace ft::inline collision

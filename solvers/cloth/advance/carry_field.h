// The base displacement with which cloth is carried while the body advances: cloth near a moving surface takes over the
// normal component of its motion, everything else its own inertia, smoothly in between.
//   min  sum_contacts w (n . (c - u_body))^2 + g |c - beta h v|^2 + 4 g |grad c|^2,   w = 1/d^2 - 1/R^2,  g = 1/R^2
// by Jacobi sweeps of 3x3 blocks. Receding surfaces count too, so that pinched cloth stays in the middle; the
// smoothness keeps an uneven carry from crossing the cloth with itself. |c| is capped at 1.2 max(largest |u_body| near,
// h |v|).
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "collision/broad_phase/pair_list.h"
#include "collision/step_bound/vertex_clusters.h"
#include "solvers/cloth/model/carry_smooth.h"

namespace ft::inline solvers {

struct CarryInput {
  int cloth_vertex_count = 0;
  std::span<const Vec3> x;                   ///< all positions at the start: cloth, then body [m]
  std::span<const Vec3> body_motion;         ///< per body vertex [m]
  std::span<const Vec3> inertia;             ///< beta h v per cloth vertex [m]
  const Adjacency* neighbours = nullptr;     ///< of each cloth vertex along edges
  const PairList* pairs = nullptr;           ///< cloth-body pairs at least within `range`
  std::span<const int> part_of_body_vertex;  ///< of each body vertex: the nearest face of each part pulls
  double range = 0;                          ///< R: 2 r + largest body motion [m]
  const CarrySmooth* smooth = nullptr;       ///< what has short edges; null: nothing has
  const VertexClusters* clusters = nullptr;  ///< are carried as one; null: none
  int sweeps = 10;
};

void carry_field(const CarryInput& input, std::span<Vec3> carry);

}  // namespace ft::inline solvers

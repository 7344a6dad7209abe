// A garment with fewer vertices that stands for one with many: the same outline, pins, seams, maps and pattern. What
// moves is the coarser one; the finer one's vertices ride on its triangles. For previews, and for garments with edges
// so short that nobody sees their ends part.
#pragma once

#include <optional>
#include <vector>

#include "collision/simplify/mesh_coarsen.h"
#include "solvers/cloth/model/cloth_setup.h"

namespace ft::inline solvers {

struct CoarseGarment {
  ClothGarment garment;
  std::vector<int> kept;                     ///< the finer garment's vertex of each of its vertices
  std::vector<CoarsenedMesh::Place> places;  ///< of each of the finer garment's vertices on it
  std::vector<int> into;                     ///< its vertex that each of the finer garment's was drawn into, or is
};

/// Edges get `factor` times as long. All sewn vertices are kept.
CoarseGarment coarse_garment(const ClothGarment& fine, double factor);

/// No edge of a garment has to be shorter than this: a small share of the contact distance, within which nobody sees
/// what happens between cloth and body, and of the garment's typical edge, the length of what is seen to move [m].
double shortest_edge(const ClothGarment& garment);

/// The garment without edges shorter than that; none where it has no such edges, or none that can be collapsed.
std::optional<CoarseGarment> without_short_edges(const ClothGarment& fine);

}  // namespace ft::inline solvers

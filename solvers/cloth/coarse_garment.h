// A garment with fewer vertices that stands for one with many, for previews: the same outline, pins, seams, maps and
// pattern. What moves is the coarser one; the finer one's vertices ride on its triangles.
#pragma once

#include <vector>

#include "collision/mesh_coarsen.h"
#include "solvers/cloth/cloth_solver.h"

namespace ft {

struct CoarseGarment {
  ClothGarment garment;
  std::vector<int> kept;                     ///< the finer garment's vertex of each of its vertices
  std::vector<CoarsenedMesh::Place> places;  ///< of each of the finer garment's vertices on it
};

/// Edges get `factor` times as long. All sewn vertices are kept.
CoarseGarment coarse_garment(const ClothGarment& fine, double factor);

}  // namespace ft

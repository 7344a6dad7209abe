// Sewing: a vertex of one panel is drawn to a point on another's edge and kept there, by a cord (cords.h) whose length
// shrinks evenly from the distance at the start to nothing while the seam closes; from then on it has no length and a
// far higher limit. The limit keeps a panel that is caught behind an arm from being torn. For panels that are cut from
// a pattern. Caution: the two sides must not feel each other's contact, see collision/check/sewn_pairs.h.
#pragma once

#include <vector>

#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/cords.h"

namespace ft::inline solvers {

/// Constants of a seam per metre of its length, so that they do not depend on the mesh.
struct SeamSettings {
  double stiffness = 5e5;  ///< N/m2. 1e5 opens 0.3 mm under the pull of a tight waist (30 N/m), 1e6 is dear to solve
  double pull = 30;        ///< N/m while it closes: as much as stretches cotton by some per cent
  double hold = 2000;      ///< N/m afterwards: lockstitched seams break at 2000..6000
};

class Seams final : public Cords {
 public:
  explicit Seams(const ClothTopology& topology);
  std::string_view name() const override { return "seams"; }
  void begin_step(const StepContext& context) override;

 private:
  std::vector<SeamPoint> points_;
};

}  // namespace ft::inline solvers

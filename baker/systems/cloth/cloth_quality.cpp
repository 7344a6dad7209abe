#include "baker/systems/cloth/cloth_quality.h"

#include <algorithm>
#include <limits>

#include "baker/plan/quality.h"
#include "collision/simplify/coarse_body.h"

namespace ft::inline baker {
namespace {

// Tuned for less than a quarter of a final bake's time in the benchmark's scene S2 and in the samples: longer steps
// alone cost more than they save, since what may meet in a step grows faster than the step.
constexpr double k_coarsen = 2.2;       ///< edges of garments, in those of a final bake [1]
constexpr double k_coarsen_body = 2.5;  ///< of body and collider [1]
constexpr double k_deviation = 2. / 3;  ///< of the body's surface, aimed at, in the least contact distance [1]
constexpr double k_travel = 1.45;       ///< of the body in a substep, in that of a final bake [1]
constexpr int k_fewer_substeps = 4;     ///< times fewer substeps at least
constexpr double k_tolerance = 0.2;     ///< of the linear solver at least [1]

}  // namespace

void apply_quality(const Shot& shot, ClothSetup& setup) {
  if (!is_preview(shot)) return;
  setup.coarsen = k_coarsen;
  setup.feasible.max_edge *= k_coarsen_body;
  setup.travel *= k_travel;
  // Seams keep their edges: pleats along them crumple in longer steps.
  const bool sewn = std::any_of(setup.garments.begin(), setup.garments.end(),
                                [](const ClothGarment& garment) { return !garment.mesh.stitches.empty(); });
  if (!sewn) setup.min_substeps = std::max(1, setup.min_substeps / k_fewer_substeps);
  setup.linear_tolerance = std::max(k_tolerance, setup.linear_tolerance);
}

std::shared_ptr<const Trajectory> with_quality(const Shot& shot, const ClothSetup& setup,
                                               std::shared_ptr<const Trajectory> primary) {
  if (!is_preview(shot) || !primary || has_sheets(primary->surface().parts)) return primary;
  // A body that is thicker than a tight garment has room for would squeeze it through.
  double thinnest = std::numeric_limits<double>::infinity();
  for (const ClothGarment& garment : setup.garments) {
    thinnest = std::min(thinnest, garment.thickness);
    for (const double own : garment.maps.thickness) thinnest = std::min(thinnest, own);
  }
  return coarse_body(std::move(primary), k_coarsen_body, setup.feasible.max_edge, k_deviation * thinnest);
}

}  // namespace ft::inline baker

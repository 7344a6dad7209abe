// Panels into garments, in the pre-roll: seams shrink from where the panels were placed until they are closed.
// Meanwhile the cloth weighs next to nothing and is slowed down, so that panels come straight from their places to each
// other instead of falling first, and it slides, so that the garment comes to hang where it fits and not where a seam
// first met the body. Weight returns, then friction. A function of the time alone: nothing to save.
#pragma once

#include <span>
#include <vector>

#include "baker/core/edge_strain.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

/// Fills topology->seams, sewn and sewn_until from the stitches of the garments, which are at `start`.
void sew(ClothModel& model);

/// Length of the seam that each vertex holds [m]: half of its edges at the border; inside a panel its longest edge.
std::vector<double> seam_lengths(const ClothTopology& topology);

/// Rest lengths of edges of pieces that are cut from a pattern [m]; others stay.
void lengths_from_pattern(const ClothTopology& topology, RestEdges& edges);

/// Adds, per vertex, what takes weight and speed from cloth that is being sewn at this time [m/s2]. False when there is
/// none.
bool ease_sewing(const ClothModel& model, double time, std::span<const Vec3> v, std::span<Vec3> acceleration);

/// Share of friction at this time [1]: none while anything is sewn and until it has its weight, then it grows.
double sewing_friction(const ClothModel& model, double time);

}  // namespace ft::inline solvers

// What Newton's method looks at to know whether a step is done.
#pragma once

#include <span>

#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

/// Root mean square, over all edges, of the change of length by the length at rest, when their ends move from where
/// they are [m].
double strain_change(const RestEdges& rest, std::span<const Vec3> from, std::span<const Vec3> move);

/// Root mean square of the distances between two states, of all vertices [m].
double mean_distance(std::span<const Vec3> from, std::span<const Vec3> to);

/// Largest displacement of the centre of mass, between two states, of a garment that is not held (per garment, not 0:
/// held) [m].
double largest_drift(const ClothModel& model, std::span<const char> held, std::span<const Vec3> from,
                     std::span<const Vec3> to);

}  // namespace ft::inline solvers

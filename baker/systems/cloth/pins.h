// Pins of the shot file -> vertices: a painted group, weights from a file, everything near the body, or named vertices.
#pragma once

#include <span>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "baker/systems/cloth/cloth_spec.h"
#include "solvers/cloth/cloth_solver.h"

namespace ft::inline baker {

/// body: what it holds to, the primary's bind pose or another garment, and its triangles. A pin that selects nothing is
/// an error that says what there is.
Result<ClothPin> resolve_pin(const PinSpec& spec, const Mesh& garment, std::span<const Vec3> body,
                             std::span<const Triangle> triangles);

/// What a pin to a garment would find: an error where that is nothing, or where panels are still to be sewn, and a note
/// where some of its vertices find nothing.
Status check_anchor_points(std::span<const ClothGarment> garments, std::size_t own, const ClothPin& pin,
                           std::vector<std::string>& notes);

/// Distance of each point to the surface [m]; infinite when there is no triangle.
std::vector<double> distances_to_surface(std::span<const Vec3> points, std::span<const Vec3> body,
                                         std::span<const Triangle> triangles);

}  // namespace ft::inline baker

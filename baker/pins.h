// Pins of the shot file -> vertices: a painted group, weights from a file, everything near the body, or named vertices.
#pragma once

#include <span>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "io/shot/shot.h"
#include "solvers/cloth/cloth_solver.h"

namespace ft {

/// body: the primary's bind pose and its triangles. A pin that selects nothing is an error that says what there is.
Result<ClothPin> resolve_pin(const PinSpec& spec, const Mesh& garment, std::span<const Vec3> body,
                             std::span<const Triangle> triangles);

/// Distance of each point to the surface [m]; infinite when there is no triangle.
std::vector<double> distances_to_surface(std::span<const Vec3> points, std::span<const Vec3> body,
                                         std::span<const Triangle> triangles);

}  // namespace ft

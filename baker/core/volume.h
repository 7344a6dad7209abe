// What a surface encloses. Characters are often several closed shells that overlap: what lies in several counts once.
#pragma once

#include <optional>
#include <span>

#include "baker/core/mesh.h"

namespace ft {

/// Volume of all points with a positive winding number [m3], from columns through the surface `spacing` [m] apart: the
/// error is at most the area times the spacing, and much less where the surface is curved. None for a surface that is
/// open or turned inside out.
std::optional<double> enclosed_volume(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                      double spacing);

/// Centre of what is enclosed, of overlapping shells each for itself; the middle of the vertices where nothing is [m].
Vec3 volume_centre(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft

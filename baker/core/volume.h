// What a surface encloses. Characters are often several closed shells that overlap: what lies in several counts once.
#pragma once

#include <optional>
#include <span>

#include "baker/core/mesh.h"

namespace ft {

struct Lids;

/// Volume of all points with a positive winding number [m3], from columns through the surface `spacing` [m] apart: the
/// error is at most the area times the spacing, and much less where the surface is curved. An open surface is closed by
/// lids over its rims (lids.h); how much they are of it says how far the volume is a guess. None for a surface that is
/// turned inside out, or more open than k_most_open.
std::optional<double> enclosed_volume(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                      double spacing);
/// With the surface's own lids, where they are known.
std::optional<double> enclosed_volume(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                      const Lids& lids, double spacing);

/// Lids as a share of the area, beyond which nobody can say what a surface encloses: a box without its top has 0.2, a
/// bowl 0.5.
inline constexpr double k_most_open = 0.25;

/// Centre of what is enclosed, of overlapping shells each for itself; the middle of the vertices where nothing is [m].
Vec3 volume_centre(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft

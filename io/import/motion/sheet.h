// Whether the mesh of a geometry cache is a sheet: thin and open, as a baked garment is, so that it has two sides and
// no inside (SurfacePart::sheet). Told by its openings. Each is as large as the fan of triangles that its rim makes
// with the middle of the rim; what lies in the same place is joined first, so that a seam is no rim.
#pragma once

#include <span>
#include <string>

#include "baker/core/types.h"

namespace ft::inline io {

struct Openings {
  double area = 0;     ///< of all of them [m2]
  double surface = 0;  ///< of the mesh [m2]
  double share() const { return surface > 0 ? area / surface : 0; }
};
Openings openings_of(std::span<const Vec3> positions, std::span<const Triangle> triangles);

/// An open mesh is a sheet from this share of its area on [1]. Measured: a robe as it is cut 0.33, as it hangs 0.13; a
/// flat cloth 1; a body that is built around a skeleton 0.
inline constexpr double k_sheet_share = 0.05;

/// How a cache with such openings is taken, and what changes it; empty: it is all but closed.
std::string openings_note(const Openings& openings, bool is_sheet);

}  // namespace ft::inline io

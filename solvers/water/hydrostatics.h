// What still water does to a closed surface that reaches into it, exactly: the pressure below a level plane.
#pragma once

#include <span>

#include "baker/core/types.h"
#include "baker/core/wrench.h"

namespace ft::inline solvers {

struct Hydrostatics {
  Wrench wrench;      ///< N, torque about `about` [N m]
  double volume = 0;  ///< below the level [m3]
};

/// weight: density times gravity [N/m3]. Overlapping shells count each for themselves.
Hydrostatics hydrostatics(std::span<const Vec3> positions, std::span<const Triangle> triangles, double level,
                          double weight, const Vec3& about);

/// Area of a closed surface as seen along a direction of length 1 [m2]; exact where it is convex.
double facing_area(std::span<const Vec3> positions, std::span<const Triangle> triangles, const Vec3& direction);

}  // namespace ft::inline solvers

// A skin that moves through the surface: what of it is under water, by vertical rays, as little volumes with a depth
// each; and what a splash needs to know of its crossing. Where several of its shells overlap, once.
// Under water means below the level at rest, so that what goes in comes out again exactly, whatever the waves.
#pragma once

#include <vector>

#include "baker/core/wrench.h"
#include "solvers/water/pond/float_contact.h"

namespace ft::inline solvers {

struct VolumePiece {
  double x = 0, z = 0, depth = 0, volume = 0;  ///< pool [m], m3
};

struct SkinUnderWater {
  std::vector<VolumePiece> pieces;
  double volume = 0;                    ///< m3
  double section = 0;                   ///< area in the surface [m2]
  double section_x = 0, section_z = 0;  ///< its middle [m]
  double top = 0, bottom = 0;           ///< heights of the skin [m]
  double top_x = 0, top_z = 0;          ///< m
};

/// spacing: of the rays [m].
SkinUnderWater skin_under_water(std::span<const Vec3> positions, std::span<const Triangle> triangles, double spacing);

/// Pressure of rest depth below the given surface heights, and drag of panels that move towards the water:
/// 1/2 rho (v n)^2. About the origin of the positions.
Wrench skin_force(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                  std::span<const Triangle> triangles, const PondModes& modes, std::span<const double> heights,
                  double gravity, double density);

/// Between cells, at a place of the pool.
double height_at(const PondModes& modes, std::span<const double> heights, double x, double z);

}  // namespace ft::inline solvers

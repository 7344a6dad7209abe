// Where a surface is no height field: around a cavity the vertices of its grid are drawn in and go down the wall.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "io/volume/openvdb_write.h"

namespace ft::inline io {

/// A rectangle of the surface in which vertices are not above their places on the grid.
struct DrawnInPatch {
  int first_i = 0, last_i = 0, first_k = 0, last_k = 0;  ///< vertices around it, which are in their places
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();          ///< its x and z [m]
  bool holds(double x, double z) const { return x >= low.x() && x <= high.x() && z >= low.y() && z <= high.y(); }
};

/// Around all such vertices; none: the surface is a height field.
std::optional<DrawnInPatch> drawn_in_patch(const LiquidFrame& water);

/// Of a voxel near the surface.
struct VoxelOfSurface {
  std::array<int, 3> place{};
  float distance = 0;  ///< to the liquid's surface, sides and floor; below 0 within [m]
  /// Of the nearest place of the surface; none nearest to a side or the floor.
  std::optional<Vec3> velocity{};
  double foam = 0;  ///< 0 to 1
};

/// All voxels of a patch that are nearer to the surface than `far` [m].
void visit_patch(const LiquidFrame& water, const DrawnInPatch& patch, double far,
                 const std::function<void(const VoxelOfSurface&)>& visit);

}  // namespace ft::inline io

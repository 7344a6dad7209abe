// A frame of a liquid whose surface is a height field but for the cavities in it, and of its droplets, as an OpenVDB
// file: grids `surface` (a level set [m]), `vel` (m/s), `spray` (a fog: share of a voxel that is water) and, of a
// liquid that has it, `foam` (a fog about the surface: share of it that is covered, less with the distance from it).
// `vel` goes on above and below the surface and around droplets as far as they come in half a frame, since that is
// where renderers look it up; not beyond the sides of the water. The same input gives the same bytes: the file's random
// identifier becomes a hash of it.
#pragma once

#include <filesystem>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"
#include "io/cache/frame.h"

namespace ft::inline io {

struct LiquidFrame {
  int across = 0, along = 0;  ///< vertices of the surface in x and z, 2 or more each
  /// Its vertices, x fastest, over a grid of equal squares; those around a cavity are drawn into it, beside their
  /// places on the grid; never those of the rim [m].
  std::vector<Vec3f> surface;
  std::vector<Vec3f> velocities;  ///< of those [m/s]; may be empty
  std::vector<float> foam;        ///< of those, 0 to 1; empty: the liquid has none, and the file no such grid
  FrameData droplets;             ///< points with velocities and widths; may be empty
  double floor = 0;               ///< the level set is closed by its sides and, at this height, from below [m]
  double voxel = 0.05;            ///< m
  double fps = 24;                ///< kept with the grids
};

Status write_liquid_vdb(const std::filesystem::path& path, const LiquidFrame& water);

}  // namespace ft::inline io

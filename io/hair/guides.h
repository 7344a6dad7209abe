// Guides of hair from files: lines, root first. For the kind of secondary that moves hair.
//
//   .tfx   TressFX, version 4: guide strands of one vertex count
//   .obj   polylines (l), or a hair mesh of cards and tubes, whose middle lines are the guides (hair_mesh.h)
//   .abc   Alembic curves, all objects of the file, first sample
//
// Careful: whether the first vertex of a line is its root is what the file says; of a hair mesh it is found.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "io/hair/hair_mesh.h"

namespace ft::inline io {

struct GuideSet {
  std::vector<std::vector<Vec3>> strands;  ///< root first, no vertex twice in a row, at least 2 each [m], Y up
  std::vector<double> widths;              ///< diameters at the roots, for each strand, or empty [m]
  std::vector<std::string> notes;          ///< what was left out or guessed
  Mesh ridden;                             ///< the hair mesh, where guides are its middle lines [m]; else empty
  std::vector<Rider> riders;               ///< for each vertex of `ridden`: where it rides
};

/// Strands that are shorter are no hair and are left out with a note [m].
inline constexpr double k_shortest_strand = 1e-3;

/// By the file's extension. `scale`: metres per unit of the file, above 0. `scalp`: points of it [m], of which a hair
/// mesh's roots are the nearest ends; empty: the higher ends are. Errors name the file: what is cut short, not finite
/// or too far away, holds no curves, or has counts that the file is too small for.
Result<GuideSet> read_guides(const std::filesystem::path& file, double scale, std::span<const Vec3> scalp = {});

}  // namespace ft::inline io

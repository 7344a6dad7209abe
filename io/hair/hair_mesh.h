// The middle lines of a hair mesh of cards and tubes, and where its vertices ride on them. Each connected piece that is
// a strip or a tube becomes a strand: the long way (long_way.h) is cut into slices (slices.h), whose centres are the
// line. Pieces that are none, such as caps, get no strand.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/mesh.h"

namespace ft::inline io {

/// Where a vertex of a hair mesh is along a strand.
struct Rider {
  int strand = -1;        ///< -1: none is near; the vertex stays with the head
  double along = 0;       ///< of the strand's length, 0 at the root, 1 at the tip
  bool of_strand = true;  ///< its piece made the strand; else, of caps and the like, the strand is only the nearest
};

struct MiddleLines {
  std::vector<std::vector<Vec3>> strands;  ///< root first [m]
  std::vector<Rider> riders;               ///< for each vertex
  std::vector<std::string> notes;          ///< which pieces are no strips, how roots were found
};

/// Vertices of caps ride on what passes so near [m].
inline constexpr double k_rider_reach = 0.03;

/// `mesh` in metres. Of a strand's ends the one nearer to `scalp` is the root; without a scalp the higher one.
MiddleLines middle_lines(const Mesh& mesh, std::span<const Vec3> scalp);

}  // namespace ft::inline io

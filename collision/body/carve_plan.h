// Who gives way to whom, for the feasible collider: worked out once from the parts and the bind pose, never changed
// after. A part gives way to every larger part that it is not jointed to (for those: creases.h). Where two parts touch
// or overlap in the bind pose already (thighs, an arm in its shoulder), the vertices there are free, and from there the
// gap that they must keep grows to the full one. A sheet gives way to nothing, and nothing to it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "baker/core/trajectory.h"
#include "collision/body/part_distance.h"

namespace ft::inline collision {

inline constexpr std::size_t k_cluster = 16;  ///< consecutive local vertices that are looked at together
inline constexpr double k_free = -std::numeric_limits<double>::infinity();  ///< a vertex that keeps no distance at all

/// A larger shell that a part may have to leave: its parts, largest first.
struct Opponent {
  int shell = -1;
  std::vector<int> parts;
};

/// One part as the one that gives way. Its vertices have their own, local numbering.
struct Yielding {
  std::vector<int> vertices;  ///< refined vertices (representatives), neighbours in space near each other in the list
  std::vector<Edge> edges;    ///< local
  Adjacency neighbours;       ///< local
  std::vector<Opponent> opponents;
  std::vector<char> allowed;  ///< per part: larger and not jointed
  /// Per part touched in the bind pose: distance that each vertex must keep from it [m], k_free or up to the gap.
  std::vector<std::pair<int, std::vector<double>>> touching;

  const std::vector<double>* touching_part(int part) const {
    for (const auto& [other, keep] : touching)
      if (other == part) return &keep;
    return nullptr;
  }
};

struct CarvePlan {
  double gap = 0;  ///< m
  std::vector<SurfacePart> parts;
  std::vector<int> by_size;        ///< parts, largest first, ties by index
  std::vector<Yielding> yielding;  ///< per part
  std::vector<int> copies;         ///< vertices that follow their representative

  bool jointed(int a, int b) const {
    return parts[static_cast<std::size_t>(a)].parent == b || parts[static_cast<std::size_t>(b)].parent == a;
  }
  /// Distance that a local vertex of a part must keep from another part [m].
  double keep(const Yielding& part, int local, int other) const {
    const std::vector<double>* touching = part.touching_part(other);
    return touching == nullptr ? gap : (*touching)[static_cast<std::size_t>(local)];
  }
};

/// Parts by size, largest first, ties by index.
std::vector<int> parts_by_size(std::span<const SurfacePart> parts);

CarvePlan make_carve_plan(const PartSurface& surface, std::span<const SurfacePart> parts,
                          std::span<const int> part_of_vertex, std::span<const Vec3> bind, double gap);

}  // namespace ft::inline collision

// How much a vertex-face or an edge-edge pair may approach, and by how much it does: what truncate_dat.h and
// common_motion.h are made of.
//
// A plane between the features proves that they keep apart; it moves along with what all four vertices have in common.
// Two normals are tried: the one between the closest points, and the flat one (of the face, or across both edges),
// along which cloth glides over the inner edges of a flat face.
//
// The room is found from the vertices, not from the closest points: along the pair's normal the lowest vertex of the
// first feature and the highest of the second bound it. A wrong normal (sliver) then costs motion, never safety.
//
//      first      ----o-----.----      lowest vertex of the first feature
//                                          | gap
//      second     ------.----o---      highest vertex of the second feature
#pragma once

#include "collision/broad_phase/contact_pairs.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::inline collision {

/// Share of the room that a step may use [1]. The rest keeps the next step possible.
inline constexpr double k_truncate_reach = 0.9;

struct PairMove {
  std::array<Vec3, 4> x;       ///< m
  std::array<Vec3, 4> dx;      ///< wanted displacement, zero where not movable [m]
  std::array<Vec3, 4> common;  ///< the part of it that the vertex makes in any case, zero where not movable [m]
  std::array<bool, 4> movable;
};

/// Of a stencil; vertices at or past movable_end do not move, and dx and common need not hold them.
inline PairMove pair_move(const Stencil& stencil, std::span<const Vec3> x, std::span<const Vec3> dx,
                          std::span<const Vec3> common, std::size_t movable_end) {
  PairMove move;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t v = at(stencil.v[i]);
    move.x[i] = x[v];
    move.movable[i] = v < movable_end;
    move.dx[i] = move.movable[i] ? dx[v] : Vec3::Zero();
    move.common[i] = move.movable[i] ? common[v] : Vec3::Zero();
  }
  return move;
}

struct PairRoom {
  Vec3 normal;                   ///< from the second feature to the first
  std::array<double, 4> behind;  ///< how far each vertex lies behind the foremost of its feature [m]
  double gap;  ///< m; not positive where the normal does not separate the features, and nothing is proved
};

/// Along the normal between the closest points, and along the flat one. The latter's gap is 0 where there is none.
PairRoom pair_room(PairKind kind, const std::array<Vec3, 4>& x);
PairRoom flat_room(PairKind kind, const std::array<Vec3, 4>& x);
/// What a step may use of a room [m], if floor [m] is to be kept.
inline double may_use(const PairRoom& room, double floor) {
  return k_truncate_reach * std::max(0.0, room.gap - floor);
}

/// How far the vertices move towards the other feature [m], less what those farther behind may move for free.
std::array<double, 4> pair_advance(PairKind kind, const PairRoom& room, const std::array<Vec3, 4>& displacement);

struct PairApproach {
  double first, second;  ///< the largest pair_advance() of each feature [m]
  /// What the displacements take from the gap at most; the same in whatever frame they are measured [m].
  double sum() const { return first + second; }
};
PairApproach pair_approach(PairKind kind, const std::array<double, 4>& advance);

/// How far the vertices have to be moved along the normal so that the pair approaches by `too_much` less [m]; the first
/// feature retreats by its part of that (0 to 1), and of each feature only the foremost vertices do.
std::array<double, 4> pair_retreat(PairKind kind, const std::array<double, 4>& advance, const PairApproach& approach,
                                   double part_of_first, double too_much);

/// The last resort: true when the features are separated by more than `keep` [m] along the normal where the pair ends,
/// wherever in the triangle of x, x + dx and x + common each vertex is. Edges that slide past each other's ends need
/// it.
bool slides_past(PairKind kind, const PairMove& move, double keep);

}  // namespace ft::inline collision

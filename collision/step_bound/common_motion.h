// What neighbours have in common of a step: displacements that may all be made at once without any pair coming too
// near. It begins with the whole displacements; where a pair would use more than its room, they lose what the two
// features approach each other by, along the pair's normal and nothing else, until no pair is left. A patch of cloth
// that moves by many of its edges' lengths keeps nearly all of its motion in this way, and cloth that meets something
// keeps what slides along it. Where many layers leave pairs after all, their vertices move as one. The rest is for
// truncate_dat.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "collision/broad_phase/pair_view.h"
#include "collision/step_bound/motion_zones.h"
#include "collision/step_bound/pair_room.h"
#include "collision/step_bound/vertex_clusters.h"

namespace ft::inline collision {

/// Balls that the movable vertices have to stay in: at x + dx all of them do, and at x. Empty: there are none.
struct MotionBounds {
  std::span<const Vec3> from;     ///< what centres are counted from [m]
  std::span<const Vec3f> centre;  ///< m
  std::span<const float> radius;  ///< m

  Vec3 centre_of(std::size_t i) const { return from[i] + centre[i].cast<double>(); }
};

/// The largest share in [0, 1] of a displacement d that stays in the ball around the origin, from a place in it or,
/// by rounding, just outside: what does not move stays where it is.
inline double share_inside_ball(const Vec3& from, const Vec3& d, double radius) {
  const double dd = d.squaredNorm();
  if (!(dd > 0) || (from + d).squaredNorm() <= radius * radius) return 1;
  const double fd = from.dot(d), outside = from.squaredNorm() - radius * radius;
  return std::clamp((-fd + std::sqrt(std::max(0.0, fd * fd - dd * outside))) / dd, 0.0, 1.0);
}

class CommonMotion {
 public:
  /// Fills `common` from the displacements dx of the first movable_count vertices [m]; the others do not move. No
  /// vertex moves farther than by the longest dx in its cluster, so pairs that are complete for that are complete for
  /// it. Where pairs are left after the last round nothing is in common. What a vertex of a cluster loses the whole
  /// cluster loses, but for what its vertices approach each other by. Depends on the order of the pairs, not on the
  /// number of threads.
  void find(std::span<const Vec3> x, std::span<const Vec3> dx, int movable_count, const PairView& pairs, double floor,
            const MotionBounds& bounds, const VertexClusters& clusters, std::span<Vec3> common);
  int rounds() const { return rounds_; }  ///< of the last find()

 private:
  struct TightPair {
    PairKind kind;
    Stencil stencil;
    PairRoom room;
  };
  struct Problem;
  void relax_all(const Problem& problem, const PairView& pairs, const MotionBounds& bounds);
  void look_at_all(const Problem& problem, const PairView& pairs);
  void look(const Problem& problem, PairKind kind, const PairView& pairs);
  void relax(const Problem& problem, const TightPair& pair);
  void join(const Problem& problem, const MotionBounds& bounds);
  void stay_inside(const Problem& problem, const MotionBounds& bounds);

  // Of a find(), and freed with it.
  std::vector<char> changed_;  ///< per vertex: in the last round
  std::vector<char> changing_;
  std::vector<TightPair> tight_;
  MotionZones zones_;                          ///< of what moves as one
  std::vector<std::vector<TightPair>> found_;  ///< per block of pairs
  int rounds_ = 0;
};

}  // namespace ft::inline collision

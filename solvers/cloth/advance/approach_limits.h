// Pairs that would meet on the cloth's carried way, and the way changed so that they do not: what they approach by
// beyond half of their room is taken from the cloth along the pair's normal, over and over, as impulses at rest do in
// Bridson, Fedkiw and Anderson (2002), section 7; the body keeps its motion. It changes a few vertices by fractions of
// a millimetre. Harmless like all of the carry: it is where the solve starts from, not where it ends.
#pragma once

#include <span>
#include <vector>

#include "baker/core/give_back.h"
#include "collision/broad_phase/contact_pairs.h"
#include "collision/step_bound/pair_room.h"
#include "collision/step_bound/vertex_clusters.h"
#include "solvers/cloth/model/carry_smooth.h"

namespace ft::inline solvers {

class ApproachLimits {
 public:
  void clear() { give_back(limits_); }
  /// Limits the pairs, which start at x and would move by d (all vertices) [m]. What no plane separates at the start is
  /// left out.
  void add(const ContactPairs& pairs, std::span<const Vec3> x, std::span<const Vec3f> d);
  /// Changes the cloth's motion by what the limits ask; body_motion is that of the vertices behind it [m]. Depends on
  /// the order of adding.
  void apply(std::span<Vec3> cloth_motion, std::span<const Vec3> body_motion, const VertexClusters& clusters,
             const CarrySmooth& smooth) const;

 private:
  struct Limit {
    PairKind kind;
    Stencil stencil;
    PairRoom room;
  };
  std::vector<Limit> limits_;
};

}  // namespace ft::inline solvers

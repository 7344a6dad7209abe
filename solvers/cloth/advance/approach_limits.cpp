#include "solvers/cloth/advance/approach_limits.h"

namespace ft::inline solvers {
namespace {

constexpr int k_sweeps = 4;
constexpr double k_share = 0.5;  ///< of what they may use of their room that pairs are left

/// Along the flat normal where they approach by less beyond their room there.
PairRoom better_room(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& d) {
  const PairRoom room = pair_room(kind, x), flat = flat_room(kind, x);
  const auto excess = [&](const PairRoom& r) {
    return pair_approach(kind, pair_advance(kind, r, d)).sum() - may_use(r, 0);
  };
  return flat.gap > 0 && (!(room.gap > 0) || excess(flat) < excess(room)) ? flat : room;
}

}  // namespace

void ApproachLimits::add(const ContactPairs& pairs, std::span<const Vec3> x, std::span<const Vec3f> d) {
  const auto add_kind = [&](PairKind kind, const std::vector<Stencil>& stencils) {
    for (const Stencil& s : stencils) {
      const PairRoom room = better_room(kind, gather(x, s), gather(d, s));
      if (room.gap > 0) limits_.push_back({kind, s, room});
    }
  };
  add_kind(PairKind::k_vertex_face, pairs.vertex_face);
  add_kind(PairKind::k_edge_edge, pairs.edge_edge);
}

void ApproachLimits::apply(std::span<Vec3> cloth_motion, std::span<const Vec3> body_motion,
                           const VertexClusters& clusters, const CarrySmooth& smooth) const {
  const std::size_t n = cloth_motion.size();
  bool changed = true;
  CarrySmooth::Walk walk;
  for (int sweep = 0; sweep < k_sweeps && changed; ++sweep) {
    changed = false;
    for (const Limit& limit : limits_) {
      const std::array<int, 4>& v = limit.stencil.v;
      std::array<Vec3, 4> d;
      for (std::size_t k = 0; k < 4; ++k) d[k] = at(v[k]) < n ? cloth_motion[at(v[k])] : body_motion[at(v[k]) - n];
      const std::array<double, 4> advance = pair_advance(limit.kind, limit.room, d);
      const PairApproach approach = pair_approach(limit.kind, advance);
      const double too_much = approach.sum() - k_share * may_use(limit.room, 0);
      if (!(too_much > 0)) continue;
      // By halves, whoever comes: what is between others has to pass on what it is given.
      const double part_of_first = at(v[3]) >= n ? 1 : at(v[0]) >= n ? 0 : 0.5;
      const std::array<double, 4> along = pair_retreat(limit.kind, advance, approach, part_of_first, too_much);
      changed = true;
      // A cluster is carried as one, also where both features have vertices of it, and what has short edges does not
      // part.
      for (std::size_t k = 0; k < 4; ++k) {
        if (at(v[k]) >= n || along[k] == 0) continue;
        const auto shares = smooth.along_with(v[k], walk);
        for (const CarrySmooth::Share& s : shares)
          cloth_motion[at(s.vertex)] += s.weight * along[k] * limit.room.normal;
        if (shares.empty())
          for (const int i : clusters.with(v[k])) cloth_motion[at(i)] += along[k] * limit.room.normal;
      }
    }
  }
}

}  // namespace ft::inline solvers

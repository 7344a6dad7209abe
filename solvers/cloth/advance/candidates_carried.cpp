// What becomes of the pairs where the carried way of some cloth is changed, so that nothing meets on it: parted, or
// joined to zones that move as one.
#include <algorithm>

#include "baker/core/parallel.h"
#include "collision/broad_phase/swept_motion.h"
#include "collision/geometry/ccd_li2021.h"
#include "solvers/cloth/advance/candidates_touching.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;  ///< pairs per block of a loop

}  // namespace

/// The pairs of changed_ vertices anew, behind all others; of these, whether they touch on the way is asked again where
/// a vertex is in moved_.
double Candidates::renew(const ClothMotion& cloth, const PieceMotion& piece) {
  const auto any_of = [](const std::vector<char>& marks, const Stencil& s) {
    return (marks[at(s.v[0])] | marks[at(s.v[1])] | marks[at(s.v[2])] | marks[at(s.v[3])]) != 0;
  };
  Touching touching;
  const auto look_again = [&](PairKind kind, std::span<const Stencil> blocked) {
    for (const Stencil& s : blocked)
      if (!any_of(changed_, s) && !any_of(moved_, s))
        touching.take(kind, s, ccd_time(kind, gather(piece.start, s), gather(piece.all, s)));
    add_touching(kind, piece, touching);
  };
  look_again(PairKind::k_vertex_face, blocked_.vertex_face);
  look_again(PairKind::k_edge_edge, blocked_.edge_edge);
  if (std::any_of(changed_.begin(), changed_.end(), [](char c) { return c != 0; })) {
    PairList found;
    finder_.find_changed(boxes_, any_self_, changed_, found, patches_.flat(), sieve(cloth, piece, &touching));
    const auto is_changed = [&](PairKind kind) {
      return [&, kind](PairKey key) { return any_of(changed_, pairs_.features.stencil(kind, key)); };
    };
    runs_vertex_face_.erase_if(pairs_.vertex_face, is_changed(PairKind::k_vertex_face));
    runs_edge_edge_.erase_if(pairs_.edge_edge, is_changed(PairKind::k_edge_edge));
    runs_vertex_face_.add(found.vertex_face, pairs_.vertex_face);
    runs_edge_edge_.add(found.edge_edge, pairs_.edge_edge);
  }
  touching.sort();
  blocked_ = std::move(touching.pairs);
  return touching.earliest;
}

/// Those of the pairs with a vertex in moved_ and none in changed_ that touch.
void Candidates::add_touching(PairKind kind, const PieceMotion& piece, Touching& touching) const {
  const VertexWays ways{piece.start, piece.all, piece.centre, piece.slack};
  parallel_for(pairs_.of(kind).size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Stencil pair = pairs_.stencil(kind, p);
      char moved = 0, changed = 0;
      for (const int v : pair.v) moved |= moved_[at(v)], changed |= changed_[at(v)];
      if (moved == 0 || changed != 0) continue;
      const SweptMotion way(kind, pair, ways, 0, k_clear);
      if (way.judge(way.between_centres()) != SweptMotion::Verdict::k_open ||
          way.judge(way.flat()) != SweptMotion::Verdict::k_open)
        continue;
      touching.take(kind, pair, ccd_time(kind, gather(piece.start, pair), gather(piece.all, pair)));
    }
  });
}

void Candidates::join_zones(const PieceMotion& piece) {
  const auto join = [&](PairKind kind, const std::vector<Stencil>& pairs) {
    for (const Stencil& s : pairs) zones_.join(kind, s, gather(piece.start, s), gather(piece.all, s));
  };
  join(PairKind::k_vertex_face, blocked_.vertex_face);
  join(PairKind::k_edge_edge, blocked_.edge_edge);
}

double Candidates::join_blocked(const ClothMotion& cloth, PieceMotion& piece) {
  join_zones(piece);
  zones_.apply(piece.carry);
  return renew_carried(cloth, piece);
}

double Candidates::part_blocked(const ClothMotion& cloth, PieceMotion& piece) {
  limits_.add(blocked_, piece.start, piece.all);
  limits_.apply(piece.carry, piece.body_motion, model_.clusters, model_.carry_smooth);
  return renew_carried(cloth, piece);
}

/// Brings pairs() and piece up to piece.carry, where it differs from the motion that they are of. A vertex whose
/// carried place stays in its ball keeps the ball, and needs no other pairs: the planes that part the dropped ones from
/// it where it starts and in all of its ball do so on the way between, too.
double Candidates::renew_carried(const ClothMotion& cloth, PieceMotion& piece) {
  changed_.assign(boxes_.size(), 0);
  moved_.assign(boxes_.size(), 0);
  for (std::size_t i = 0; i < piece.carry.size(); ++i) {
    const Vec3f way = piece.carry[i].cast<float>();
    if (way == piece.all[i]) continue;
    moved_[i] = 1;
    piece.all[i] = way;
    if ((piece.carry[i] - piece.centre[i].cast<double>()).norm() <= piece.slack[i]) continue;
    changed_[i] = 1;
    place(i, cloth, piece);
  }
  if (any_self_) {
    lost_.clear();
    std::vector<Vec3> carried(piece.carry.size());
    for (std::size_t i = 0; i < carried.size(); ++i) carried[i] = piece.start[i] + piece.all[i].cast<double>();
    if (!patches_.keep(carried, false, lost_)) mark_lost();
  }
  return renew(cloth, piece);
}

}  // namespace ft::inline solvers

// What a solve that is under way adds to the pairs: room for vertices that want farther, and pairs inside patches of
// cloth that are flat no longer. Nothing that is in the list is looked at again: with more room and fewer patches it
// can only become longer, and the new pairs come behind those that are there.
#include "solvers/cloth/candidates.h"

namespace ft {

/// Lost patches' vertices are changed_.
void Candidates::mark_lost() {
  for (const int patch : lost_)
    for (const int t : patches_.members(patch))
      for (const int v : model_.triangles[at(t)]) changed_[at(v)] = 1;
}

void Candidates::grow(const ClothMotion& cloth, std::span<const double> more, PieceMotion& piece) {
  changed_.assign(boxes_.size(), 0);
  for (std::size_t i = 0; i < more.size(); ++i) {
    if (!(more[i] > 0)) continue;
    changed_[i] = 1;
    piece.slack[i] += more[i];
    set_box(i, cloth, piece);
  }
  add_missing(cloth, piece);
}

bool Candidates::keep_flat(const ClothMotion& cloth, std::span<const Vec3> x, const PieceMotion& piece) {
  lost_.clear();
  if (!any_self_ || patches_.keep(x, false, lost_)) return true;
  changed_.assign(boxes_.size(), 0);
  mark_lost();
  add_missing(cloth, piece);
  return false;
}

/// The pairs of changed_ vertices that pairs_ lacks. What was let pass stays out.
void Candidates::add_missing(const ClothMotion& cloth, const PieceMotion& piece) {
  finder_.find_changed(boxes_, any_self_, changed_, found_, patches_.flat());
  filter(PairKind::k_vertex_face, cloth, piece, found_.vertex_face, nullptr);
  runs_vertex_face_.add(found_.vertex_face, blocked_.vertex_face, pairs_.vertex_face);
  filter(PairKind::k_edge_edge, cloth, piece, found_.edge_edge, nullptr);
  runs_edge_edge_.add(found_.edge_edge, blocked_.edge_edge, pairs_.edge_edge);
}

}  // namespace ft

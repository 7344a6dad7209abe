// What a solve that is under way adds to the pairs: those of vertices that want to leave their room and get another,
// and pairs inside patches of cloth that are flat no longer. Nothing that is in the list is looked at again or taken
// out: the new pairs come behind those that are there.
#include <algorithm>

#include "solvers/cloth/advance/candidates.h"

namespace ft::inline solvers {

/// Lost patches' vertices are changed_.
void Candidates::mark_lost() {
  for (const int patch : lost_)
    for (const int t : patches_.members(patch))
      for (const int v : model_.triangles[at(t)]) changed_[at(v)] = 1;
}

void Candidates::give_room(const ClothMotion& cloth, std::span<const RoomRequest> requests, PieceMotion& piece) {
  changed_.assign(boxes_.size(), 0);
  for (const RoomRequest& request : requests) {
    const std::size_t i = at(request.vertex);
    changed_[i] = 1;
    piece.centre[i] = (0.5 * (request.from + request.to) - piece.start[i]).cast<float>();
    piece.slack[i] = static_cast<float>(0.5 * (request.to - request.from).norm() + request.spare);
    set_box(i, piece);
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

void Candidates::hold(const ContactPairs& closed) {
  const FeatureNumbers& of = pairs_.features;
  const auto edge = [&](int a, int b) {
    return static_cast<int>(std::lower_bound(of.cloth_edges.begin(), of.cloth_edges.end(), Edge{a, b}) -
                            of.cloth_edges.begin());
  };
  std::vector<PairKey> vertex_face, edge_edge;
  for (const Stencil& s : closed.vertex_face) {
    const Triangle face{s.v[1], s.v[2], s.v[3]};
    const auto found = std::find(of.cloth_faces.begin(), of.cloth_faces.end(), face);
    vertex_face.push_back(pair_key(s.v[0], static_cast<int>(found - of.cloth_faces.begin())));
  }
  for (const Stencil& s : closed.edge_edge) edge_edge.push_back(pair_key(edge(s.v[0], s.v[1]), edge(s.v[2], s.v[3])));
  std::sort(vertex_face.begin(), vertex_face.end());
  std::sort(edge_edge.begin(), edge_edge.end());
  runs_vertex_face_.add(vertex_face, pairs_.vertex_face);
  runs_edge_edge_.add(edge_edge, pairs_.edge_edge);
}

/// The pairs of changed_ vertices that pairs_ lacks. What was let pass stays out.
void Candidates::add_missing(const ClothMotion& cloth, const PieceMotion& piece) {
  PairList found;
  finder_.find_changed(boxes_, any_self_, changed_, found, patches_.flat(), sieve(cloth, piece, nullptr));
  std::erase_if(found.vertex_face, [&](PairKey key) { return is_blocked(PairKind::k_vertex_face, key); });
  std::erase_if(found.edge_edge, [&](PairKey key) { return is_blocked(PairKind::k_edge_edge, key); });
  runs_vertex_face_.add(found.vertex_face, pairs_.vertex_face);
  runs_edge_edge_.add(found.edge_edge, pairs_.edge_edge);
}

}  // namespace ft::inline solvers

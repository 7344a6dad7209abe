// Who is let through whom where there is no room. Cloth between parts that close on it stays with the largest of them,
// on the side where it is, and is let through the others; when these open again, it is where it was.
#include <algorithm>
#include <utility>

#include "solvers/cloth/candidates.h"

namespace ft {

/// Per cloth vertex: the part that has to let it through, where it is in a blocked zone that has met several parts;
/// else -1. The largest part holds the zone.
std::vector<int> Candidates::pinched_through() const {
  const std::size_t n = at(model_.vertex_count());
  const auto larger = [&](int a, int b) { return b < 0 || model_.part_rank[at(a)] < model_.part_rank[at(b)]; };
  std::vector<std::array<int, 2>> met(n, {-1, -1});  // per zone: the largest part and the next
  for (const MotionZones::BodyMotion& m : zones_.body_met()) {
    auto& [first, second] = met[at(zones_.root(m.vertex))];
    const int part = model_.collider->part_of_vertex()[at(m.body_vertex) - n];
    if (part == first || part == second) continue;
    if (larger(part, first))
      second = std::exchange(first, part);
    else if (larger(part, second))
      second = part;
  }
  std::vector<char> blocked_zone(n, 0);
  for (const auto* blocked : {&blocked_.vertex_face, &blocked_.edge_edge})
    for (const Stencil& stencil : *blocked)
      for (const int v : stencil.v)
        if (at(v) < n) blocked_zone[at(zones_.root(v))] = 1;
  std::vector<int> through(n, -1);
  for (std::size_t v = 0; v < n; ++v) {
    const std::size_t zone = at(zones_.root(static_cast<int>(v)));
    if (blocked_zone[zone] != 0) through[v] = met[zone][1];
  }
  return through;
}

int Candidates::release_blocked(ClothMotion& cloth, const PieceMotion& piece) {
  join_zones(piece);
  const std::vector<int> through = pinched_through();
  int freed = 0;
  const auto let_through = [&](int v, int part) {
    if (part < 0 || model_.may_pass(cloth.released[at(v)], part)) return;
    cloth.released[at(v)] = part;
    ++freed;
  };
  for (const auto* blocked : {&blocked_.vertex_face, &blocked_.edge_edge})
    for (const Stencil& stencil : *blocked)
      for (const int v : stencil.v)
        if (v < model_.vertex_count() && through[at(v)] < 0) let_through(v, part_of(stencil));
  for (std::size_t v = 0; v < through.size(); ++v) let_through(static_cast<int>(v), through[v]);
  drop_blocked();
  return freed;
}

int Candidates::release_beside(ClothMotion& cloth, const PieceMotion& piece) {
  if (std::all_of(cloth.released.begin(), cloth.released.end(), [](int part) { return part < 0; })) return 0;
  join_zones(piece);
  const std::vector<int> through = pinched_through();
  std::vector<char> beside(through.size(), 0);  // per zone
  const auto look = [&](int v, int w) {
    if (through[at(v)] >= 0 && model_.may_pass(cloth.released[at(w)], through[at(v)])) beside[at(zones_.root(v))] = 1;
  };
  for (const Edge& e : model_.rest_edges.edges) look(e[0], e[1]), look(e[1], e[0]);
  int freed = 0;
  for (int v = 0; v < model_.vertex_count(); ++v) {
    if (beside[at(zones_.root(v))] == 0 || model_.may_pass(cloth.released[at(v)], through[at(v)])) continue;
    cloth.released[at(v)] = through[at(v)];
    ++freed;
  }
  return freed;
}

}  // namespace ft

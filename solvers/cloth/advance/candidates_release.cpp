// What is let go where there is no room. Cloth between parts that close on it stays with the largest of them, on the
// side where it is; the others are absent for it until it is clear of them (absence.h).
#include <algorithm>
#include <utility>

#include "solvers/cloth/advance/candidates.h"

namespace ft::inline solvers {

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

int Candidates::release_blocked(ClothMotion& cloth, const PieceMotion& piece, std::span<const char> deep, bool whole) {
  join_zones(piece);
  const std::vector<int> through = pinched_through();
  const int n = model_.vertex_count();
  const std::span<const Vec3> body = std::span(piece.start).subspan(at(n));
  const auto parts = model_.collider ? model_.collider->part_of_vertex() : std::span<const int>{};
  std::vector<std::vector<int>> goes(model_.setup.garments.size());  // per garment
  const auto holds = [&](int v, int part) {
    return through[at(v)] >= 0 && model_.part_rank[at(part)] < model_.part_rank[at(through[at(v)])];
  };
  const auto take_blocking = [&](bool holding, std::span<const Stencil> blocked) {
    for (const Stencil& stencil : blocked) {
      const int part = part_of(stencil);
      if (part < 0) continue;
      for (const int v : stencil.v) {
        if (v >= n || holds(v, part) != holding) continue;
        for (const int b : stencil.v)
          if (b >= n) goes[at(model_.garment_of(v))].push_back(b - n);
      }
    }
  };
  const auto let_go = [&] {
    int freed = 0;
    for (int g = 0; g < static_cast<int>(goes.size()); ++g)
      if (!goes[at(g)].empty() && whole)
        freed += model_.absence.let_go_of_all(g, cloth.absent);
      else if (!goes[at(g)].empty())
        freed += model_.absence.let_go(model_, g, goes[at(g)], body, deep, cloth.absent);
    return freed;
  };
  for (const auto* blocked : {&blocked_.vertex_face, &blocked_.edge_edge}) take_blocking(false, *blocked);
  for (const MotionZones::BodyMotion& m : zones_.body_met()) {
    const int b = m.body_vertex - n;
    if (through[at(m.vertex)] >= 0 && !holds(m.vertex, parts[at(b)]))
      goes[at(model_.garment_of(m.vertex))].push_back(b);
  }
  int freed = let_go();
  if (freed == 0) {  // the part that holds the cloth is all that blocks it
    for (const auto* blocked : {&blocked_.vertex_face, &blocked_.edge_edge}) take_blocking(true, *blocked);
    freed = let_go();
  }
  drop_blocked();
  return freed;
}

}  // namespace ft::inline solvers

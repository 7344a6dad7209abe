// Which vertices of a part may have to move: those nearer to a larger part than they must be, and those inside one.
#include <algorithm>

#include "baker/core/parallel.h"
#include "collision/body/carver.h"

namespace ft::inline collision {

TreeBox Carver::box_of(int part, std::span<const Vec3> x) const {
  Box box;
  for (const int v : plan.yielding[at(part)].vertices) box.include(x[at(v)]);
  return TreeBox::around(box.lo, box.hi);
}

/// Opponents whose boxes, grown by the gap, meet the part's now; their trees are brought up to date.
std::vector<Opponent> Carver::opponents_now(const Yielding& part, const TreeBox& own, Scratch& scratch) const {
  std::vector<Opponent> out;
  for (const Opponent& opponent : part.opponents) {
    Opponent now{opponent.shell, {}};
    for (const int other : opponent.parts) {
      if (!own.overlaps(scratch.boxes[at(other)], 2 * settings.max_edge + settings.gap)) continue;
      TriangleTree& tree = scratch.trees[at(other)];
      if (tree.empty()) {
        tree = surface->tree(other);
        tree.refit(scratch.x, surface->triangles());
      }
      if (own.overlaps(tree.box(), settings.gap)) now.parts.push_back(other);
    }
    if (!now.parts.empty()) out.push_back(std::move(now));
  }
  return out;
}

/// Far vertices of unknown side: those connected to one that is away are away too, for an edge cannot pass the
/// opponent's surface without an end near it. Of the others a closed opponent is asked once per connected piece, an
/// open one for every vertex.
void Carver::resolve_unknown(const Carving& carving, const Opponent& opponent, const Scratch& scratch,
                             std::vector<Side>& side) const {
  const Yielding& part = carving.part;
  std::vector<int> unknown, queue;
  for (int v = 0; v < static_cast<int>(side.size()); ++v)
    if (side[at(v)] == Side::k_unknown) unknown.push_back(v);
  const auto grow = [&](Side as) {
    while (!queue.empty()) {
      const int v = queue.back();
      queue.pop_back();
      for (const int w : part.neighbours.row(v))
        if (side[at(w)] == Side::k_unknown) side[at(w)] = as, queue.push_back(w);
    }
  };
  for (const int v : unknown) {
    const auto row = part.neighbours.row(v);
    if (side[at(v)] != Side::k_unknown ||
        std::none_of(row.begin(), row.end(), [&](int w) { return side[at(w)] == Side::k_away; }))
      continue;
    side[at(v)] = Side::k_away;
    queue.assign(1, v);
    grow(Side::k_away);
  }
  const bool closed = opponent.parts.size() == 1 && surface->closed(opponent.parts[0]);
  double reach = 0;
  for (const int other : opponent.parts) reach = std::max(reach, surface->depth_limit(other));
  for (const int v : unknown) {
    if (side[at(v)] != Side::k_unknown) continue;
    int hint = -1;
    const auto answer = surface->distance(scratch.x[at(part.vertices[at(v)])], opponent.parts, part.allowed, reach,
                                          {scratch.x, scratch.trees}, hint);
    side[at(v)] = answer && answer->distance < 0 ? Side::k_inside : Side::k_away;
    if (!closed) continue;
    const Side as = side[at(v)];
    queue.assign(1, v);
    grow(as);
  }
}

/// Sides and contacts of one cluster of vertices [begin, end) with respect to one opponent.
void Carver::look_around(Carving& carving, const Opponent& opponent, const Scratch& scratch, std::size_t begin,
                         std::size_t end, NearbyTriangles& nearby, std::vector<Side>& side) const {
  const Yielding& part = carving.part;
  Box box;  // of the vertices that are near a tree and have to keep a distance
  bool any = false;
  for (std::size_t i = begin; i < end; ++i) {
    side[i] = Side::k_away;
    const Vec3& p = scratch.x[at(part.vertices[i])];
    for (const int other : opponent.parts) {
      if (scratch.trees[at(other)].box().squared_distance(p) > near * near) continue;
      const bool free = plan.keep(part, static_cast<int>(i), other) == k_free;
      // Free vertices stand where the surfaces overlap for good: sides must not spread over them.
      if (!free)
        side[i] = Side::k_unknown;
      else if (side[i] == Side::k_away)
        side[i] = Side::k_near;
    }
    if (side[i] != Side::k_unknown) continue;
    any = true;
    box.include(p);
  }
  if (!any) return;
  box.inflate(near);
  nearby.begin(TreeBox::around(box.lo, box.hi));
  for (const int other : opponent.parts) nearby.add(scratch.trees[at(other)], scratch.x, surface->triangles());
  for (std::size_t i = begin; i < end; ++i) {
    if (side[i] != Side::k_unknown) continue;
    const Vec3& p = scratch.x[at(part.vertices[i])];
    const TriangleTree::Hit hit = nearby.closest(p, near, scratch.x, surface->triangles());
    if (hit.triangle < 0) continue;
    side[i] = Side::k_near;
    const auto answer = surface->judge(p, hit, part.allowed, scratch.x);
    if (!answer) continue;
    const double keep = plan.keep(part, static_cast<int>(i), answer->part);
    if (keep == settings.gap && answer->distance < carving.contacts[i].distance)
      carving.contacts[i] = {answer->normal, answer->distance};
    if (answer->distance < keep) carving.is_active[i] = 1;
  }
}

void Carver::find_active(Carving& carving, const Scratch& scratch) const {
  const std::size_t count = carving.part.vertices.size();
  std::vector<Side> side(count);
  for (const Opponent& opponent : carving.opponents) {
    parallel_for(count, k_carve_block, [&](std::size_t begin, std::size_t end) {
      NearbyTriangles nearby;
      for (std::size_t i = begin; i < end; i += k_cluster)
        look_around(carving, opponent, scratch, i, std::min(end, i + k_cluster), nearby, side);
    });
    if (std::find(side.begin(), side.end(), Side::k_unknown) == side.end()) continue;
    resolve_unknown(carving, opponent, scratch, side);
    for (std::size_t i = 0; i < count; ++i)
      if (side[i] == Side::k_inside) carving.inside[i] = carving.is_active[i] = 1;
  }
  for (std::size_t i = 0; i < count; ++i)
    if (carving.is_active[i] != 0) carving.active.push_back(static_cast<int>(i));
}

}  // namespace ft::inline collision

// See carve_plan.h.
#include "collision/body/carve_plan.h"

#include <algorithm>
#include <numeric>

#include "baker/core/parallel.h"

namespace ft::inline collision {
namespace {

/// Bind distance from which on vertices of touching parts keep the full gap [m].
constexpr double k_touching_zone = 30e-3;

/// Orders points by median splits down to clusters.
void sort_in_space(std::span<int> vertices, std::span<const Vec3> x) {
  if (vertices.size() <= k_cluster) return;
  Box box;
  for (const int v : vertices) box.include(x[at(v)]);
  int axis = 0;
  (box.hi - box.lo).maxCoeff(&axis);
  const std::size_t half = (vertices.size() / k_cluster + 1) / 2 * k_cluster;
  const auto middle = vertices.begin() + static_cast<std::ptrdiff_t>(half);
  std::nth_element(vertices.begin(), middle, vertices.end(), [&](int a, int b) {
    return x[at(a)][axis] < x[at(b)][axis] || (x[at(a)][axis] == x[at(b)][axis] && a < b);
  });
  std::sort(vertices.begin(), middle);
  std::sort(middle, vertices.end());
  sort_in_space(vertices.first(half), x);
  sort_in_space(vertices.subspan(half), x);
}

void share_out_vertices(CarvePlan& plan, const PartSurface& surface, std::span<const int> part_of_vertex,
                        std::span<const Vec3> bind) {
  const auto representative = surface.representative();
  std::vector<int> local(representative.size(), -1);
  for (int v = 0; v < static_cast<int>(representative.size()); ++v) {
    if (representative[at(v)] != v)
      plan.copies.push_back(v);
    else
      plan.yielding[at(part_of_vertex[at(v)])].vertices.push_back(v);
  }
  for (Yielding& part : plan.yielding) {
    sort_in_space(part.vertices, bind);
    for (std::size_t i = 0; i < part.vertices.size(); ++i) local[at(part.vertices[i])] = static_cast<int>(i);
  }
  for (const Edge& e : unique_edges(surface.triangles())) {
    const int part = part_of_vertex[at(e[0])];
    if (e[0] != e[1] && part == part_of_vertex[at(e[1])])
      plan.yielding[at(part)].edges.push_back({local[at(e[0])], local[at(e[1])]});
  }
  for (Yielding& part : plan.yielding) part.neighbours = vertex_neighbours(part.vertices.size(), part.edges);
}

void find_opponents(CarvePlan& plan, const PartSurface& surface) {
  for (std::size_t rank = 0; rank < plan.by_size.size(); ++rank) {
    const int p = plan.by_size[rank];
    Yielding& part = plan.yielding[at(p)];
    part.allowed.assign(plan.parts.size(), 0);
    if (plan.parts[at(p)].sheet) continue;
    for (std::size_t larger = 0; larger < rank; ++larger) {
      const int other = plan.by_size[larger];
      if (plan.parts[at(other)].sheet || plan.jointed(p, other) || surface.tree(other).empty()) continue;
      part.allowed[at(other)] = 1;
      const auto found = std::find_if(part.opponents.begin(), part.opponents.end(),
                                      [&](const Opponent& o) { return o.shell == surface.shell(other); });
      if (found != part.opponents.end())
        found->parts.push_back(other);
      else
        part.opponents.push_back({surface.shell(other), {other}});
    }
  }
}

void find_touching(const CarvePlan& plan, Yielding& part, const PartSurface& surface, std::span<const Vec3> bind,
                   std::span<const TriangleTree> trees) {
  if (part.vertices.empty()) return;
  Box box;
  for (const int v : part.vertices) box.include(bind[at(v)]);
  const TreeBox own = TreeBox::around(box.lo, box.hi);
  for (const Opponent& opponent : part.opponents)
    for (const int other : opponent.parts) {
      if (!own.overlaps(trees[at(other)].box(), plan.gap)) continue;
      std::vector<double> keep(part.vertices.size(), plan.gap);
      const double reach = std::max({surface.depth_limit(other), plan.gap, k_touching_zone});
      const int one[1] = {other};
      bool touches = false;
      int hint = -1;
      for (std::size_t i = 0; i < keep.size(); ++i) {
        const Vec3& p = bind[at(part.vertices[i])];
        if (trees[at(other)].box().squared_distance(p) > k_touching_zone * k_touching_zone) continue;
        const auto answer = surface.distance(p, one, part.allowed, reach, {bind, trees}, hint);
        if (!answer || answer->distance >= k_touching_zone) continue;
        keep[i] = answer->distance <= 0 ? k_free : plan.gap - 2 * (k_touching_zone - answer->distance);
        touches = touches || answer->distance < plan.gap;
      }
      if (touches) part.touching.emplace_back(other, std::move(keep));
    }
}

}  // namespace

std::vector<int> parts_by_size(std::span<const SurfacePart> parts) {
  std::vector<int> order(parts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const SurfacePart &p = parts[at(a)], &q = parts[at(b)];
    return p.fixed != q.fixed ? p.fixed : p.size > q.size;
  });
  return order;
}

CarvePlan make_carve_plan(const PartSurface& surface, std::span<const SurfacePart> parts,
                          std::span<const int> part_of_vertex, std::span<const Vec3> bind, double gap) {
  CarvePlan plan;
  plan.gap = gap;
  plan.parts.assign(parts.begin(), parts.end());
  plan.by_size = parts_by_size(parts);
  plan.yielding.resize(parts.size());
  share_out_vertices(plan, surface, part_of_vertex, bind);
  find_opponents(plan, surface);
  std::vector<TriangleTree> trees;
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) trees.push_back(surface.tree(p));
  parallel_tasks(parts.size(), [&](std::size_t p) { find_touching(plan, plan.yielding[p], surface, bind, trees); });
  return plan;
}

}  // namespace ft::inline collision

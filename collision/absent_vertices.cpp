#include "collision/absent_vertices.h"

#include "collision/penetration.h"

namespace ft {
namespace {

/// A surface point is asked for its side from so far outside its own triangles [m].
constexpr double k_above = 1e-4;

}  // namespace

AbsentVertices::AbsentVertices(const PartSurface& surface, std::span<const Vec3> bind,
                               std::span<const int> part_of_vertex, std::span<const int> rank, double deepest)
    : surface_(&surface), tree_(bind, surface.triangles()), deepest_(deepest) {
  rank_of_vertex_.reserve(part_of_vertex.size());
  for (const int part : part_of_vertex) rank_of_vertex_.push_back(rank[at(part)]);
  neighbours_ = vertex_neighbours(bind.size(), unique_edges(surface.triangles()));
}

void AbsentVertices::find(std::span<const Vec3> before, std::span<const Vec3> after, std::span<char> absent) const {
  const auto triangles = surface_->triangles();
  std::vector<int> queue;
  for (std::size_t v = 0; v < before.size(); ++v) {
    absent[v] = (after[v] - before[v]).squaredNorm() > deepest_ * deepest_ ? 1 : 0;
    if (absent[v] != 0) queue.push_back(static_cast<int>(v));
  }
  if (queue.empty()) return;
  TriangleTree tree = tree_;
  tree.refit(before, triangles);
  const std::vector<Vec3> normals = vertex_normals(before, triangles);
  std::vector<char> asked(before.size(), 0);
  while (!queue.empty()) {
    const int v = queue.back();
    queue.pop_back();
    for (const int w : neighbours_.row(v)) {
      if (absent[at(w)] != 0 || asked[at(w)] != 0) continue;
      // The larger part that a limb is in stays, although it is inside the limb.
      if (rank_of_vertex_[at(w)] < rank_of_vertex_[at(v)] || after[at(w)] != before[at(w)]) continue;
      asked[at(w)] = 1;
      if (!is_inside(before[at(w)] + k_above * normals[at(w)], before, triangles, tree)) continue;
      absent[at(w)] = 1;
      queue.push_back(w);
    }
  }
  const auto representative = surface_->representative();
  for (std::size_t v = 0; v < absent.size(); ++v) absent[v] = absent[at(representative[v])];
}

}  // namespace ft

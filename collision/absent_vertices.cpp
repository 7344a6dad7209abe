#include "collision/absent_vertices.h"

#include <algorithm>

#include "baker/core/parallel.h"
#include "collision/penetration.h"

namespace ft {
namespace {

/// A surface point is asked for its side from so far outside its own triangles [m].
constexpr double k_above = 1e-4;
/// Surfaces look at each other where the cosine of their normals is below the negative of this.
constexpr double k_facing = 0.3;
/// A part that has to give way by this share of its half thickness is not pressed flat yet [1].
constexpr double k_pressed_flat = 0.6;

}  // namespace

AbsentVertices::AbsentVertices(const PartSurface& surface, std::span<const Vec3> bind,
                               std::span<const int> part_of_vertex, std::span<const SurfacePart> parts,
                               std::span<const int> rank, double deepest, double room)
    : surface_(&surface), tree_(bind, surface.triangles()), room_(room) {
  rank_of_vertex_.reserve(part_of_vertex.size());
  deepest_of_vertex_.reserve(part_of_vertex.size());
  part_of_vertex_.assign(part_of_vertex.begin(), part_of_vertex.end());
  for (const SurfacePart& part : parts) parents_.push_back(part.parent);
  for (const int part : part_of_vertex) {
    rank_of_vertex_.push_back(rank[at(part)]);
    deepest_of_vertex_.push_back(static_cast<float>(std::max(deepest, k_pressed_flat * surface.half_thickness(part))));
  }
  neighbours_ = vertex_neighbours(bind.size(), unique_edges(surface.triangles()));
}

void AbsentVertices::find(std::span<const Vec3> before, std::span<const Vec3> after, std::span<char> absent) const {
  find_deep(before, after, absent);
  find_folds(after, absent);
  const auto representative = surface_->representative();
  for (std::size_t v = 0; v < absent.size(); ++v) absent[v] = absent[at(representative[v])];
}

void AbsentVertices::find_deep(std::span<const Vec3> before, std::span<const Vec3> after,
                               std::span<char> absent) const {
  const auto triangles = surface_->triangles();
  std::vector<int> queue;
  for (std::size_t v = 0; v < before.size(); ++v) {
    absent[v] = (after[v] - before[v]).norm() > deepest_of_vertex_[v] ? 1 : 0;
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
      if (!rays_say_inside(before[at(w)] + k_above * normals[at(w)], tree, before, triangles)) continue;
      absent[at(w)] = 1;
      queue.push_back(w);
    }
  }
}

std::vector<int> AbsentVertices::near_larger_parts(std::span<const Vec3> x, std::span<const char> absent) const {
  const auto representative = surface_->representative();
  std::vector<Box> boxes(parents_.size());
  std::vector<int> rank(parents_.size(), 0);
  for (std::size_t v = 0; v < x.size(); ++v) {
    boxes[at(part_of_vertex_[v])].include(x[v]);
    rank[at(part_of_vertex_[v])] = rank_of_vertex_[v];
  }
  for (Box& box : boxes) box.inflate(room_);
  std::vector<std::vector<Box>> larger(parents_.size());  // per part
  for (std::size_t part = 0; part < boxes.size(); ++part)
    for (std::size_t other = 0; other < boxes.size(); ++other)
      if (rank[other] < rank[part] && !jointed(static_cast<int>(part), static_cast<int>(other)) &&
          boxes[part].overlaps(boxes[other]))
        larger[part].push_back(boxes[other]);
  std::vector<int> out;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (absent[v] != 0 || at(representative[v]) != v) continue;
    const auto holds = [&p = x[v]](const Box& box) {
      return (p.array() >= box.lo.array()).all() && (p.array() <= box.hi.array()).all();
    };
    const std::vector<Box>& of_part = larger[at(part_of_vertex_[v])];
    if (std::any_of(of_part.begin(), of_part.end(), holds)) out.push_back(static_cast<int>(v));
  }
  return out;
}

void AbsentVertices::find_folds(std::span<const Vec3> after, std::span<char> absent) const {
  const std::vector<int> asked = near_larger_parts(after, absent);
  if (asked.empty()) return;
  const auto triangles = surface_->triangles();
  TriangleTree tree = tree_;
  tree.refit(after, triangles);
  const std::vector<Vec3> normals = vertex_normals(after, triangles);
  std::vector<char> folded(after.size(), 0);
  parallel_for(asked.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t v = at(asked[k]);
      if (normals[v] == Vec3::Zero()) continue;
      const Vec3 &p = after[v], &along = normals[v];
      tree.for_each_along(p, along, room_, [&](int index) {
        const Triangle& t = triangles[at(index)];
        if (rank_of_vertex_[at(t[0])] >= rank_of_vertex_[v]) return;
        if (jointed(part_of_vertex_[v], part_of_vertex_[at(t[0])])) return;
        for (const int corner : t)
          if (at(corner) == v || absent[at(corner)] != 0) return;
        const Vec3& a = after[at(t[0])];
        const Vec3 e = after[at(t[1])] - a, f = after[at(t[2])] - a, normal = e.cross(f);
        const double facing = -normal.dot(along);
        if (!(facing > k_facing * normal.norm())) return;
        const double distance = normal.dot(p - a) / facing;
        if (!(distance > 0) || distance > room_) return;
        const Vec3 s = p + distance * along - a;
        const double u = s.cross(f).dot(normal), w = e.cross(s).dot(normal), area = normal.squaredNorm();
        if (u >= 0 && w >= 0 && u + w <= area) folded[v] = 1;
      });
    }
  });
  for (std::size_t v = 0; v < folded.size(); ++v)
    if (folded[v] != 0) absent[v] = 1;
}

}  // namespace ft

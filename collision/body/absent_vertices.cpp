#include "collision/body/absent_vertices.h"

#include <algorithm>

#include "baker/core/parallel.h"
#include "collision/check/penetration.h"

namespace ft::inline collision {
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
    : surface_(&surface), rank_(rank.begin(), rank.end()), room_(room) {
  rank_of_vertex_.reserve(part_of_vertex.size());
  deepest_of_vertex_.reserve(part_of_vertex.size());
  part_of_vertex_.assign(part_of_vertex.begin(), part_of_vertex.end());
  for (const SurfacePart& part : parts) {
    parents_.push_back(part.parent);
    stays_.push_back(part.fixed || part.sheet ? 1 : 0);
    sheet_.push_back(part.sheet ? 1 : 0);
  }
  std::vector<int> solid;
  for (std::size_t i = 0; i < surface.triangles().size(); ++i)
    if (sheet_[at(surface.part_of_triangle(static_cast<int>(i)))] == 0) solid.push_back(static_cast<int>(i));
  tree_ = TriangleTree(bind, surface.triangles(), std::move(solid));
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

/// Trees of the larger parts that a part is not jointed to and that may be near it, refitted to positions [m].
class AbsentVertices::LargerParts {
 public:
  LargerParts(const AbsentVertices& of, std::span<const Vec3> x) : near_(of.parents_.size()), trees_(near_.size()) {
    std::vector<Box> boxes(near_.size());
    for (std::size_t v = 0; v < x.size(); ++v) boxes[at(of.part_of_vertex_[v])].include(x[v]);
    for (std::size_t part = 0; part < near_.size(); ++part) {
      Box around = boxes[part];
      around.inflate(of.room_);
      for (std::size_t other = 0; other < near_.size(); ++other) {
        if (of.sheet_[part] != 0 || of.sheet_[other] != 0) continue;
        if (of.rank_[other] >= of.rank_[part] || of.jointed(static_cast<int>(part), static_cast<int>(other)) ||
            !around.overlaps(boxes[other]))
          continue;
        near_[part].push_back({TreeBox::around(boxes[other].lo, boxes[other].hi), &trees_[other]});
        if (trees_[other].empty()) trees_[other] = of.surface_->tree(static_cast<int>(other));
      }
    }
    parallel_for(trees_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part)
        if (!trees_[part].empty()) trees_[part].refit(x, of.surface_->triangles());
    });
  }
  /// Calls visit(triangle) for what such parts have near the segment between a and b, which is short.
  template <class Visit>
  void for_each_near(int part, const Vec3& a, const Vec3& b, Visit&& visit) const {
    const std::vector<Larger>& larger = near_[at(part)];
    if (larger.empty()) return;
    const TreeBox box = TreeBox::around(a.cwiseMin(b), a.cwiseMax(b));
    for (const auto& [around, tree] : larger)
      if (around.overlaps(box)) tree->for_each_near(box, visit);
  }
  bool none() const {
    return std::all_of(near_.begin(), near_.end(), [](const auto& larger) { return larger.empty(); });
  }

 private:
  struct Larger {
    TreeBox box;
    const TriangleTree* tree;
  };
  std::vector<std::vector<Larger>> near_;  ///< per part
  std::vector<TriangleTree> trees_;
};

void AbsentVertices::find_folds(std::span<const Vec3> after, std::span<char> absent) const {
  const LargerParts larger(*this, after);
  if (larger.none()) return;
  const auto triangles = surface_->triangles();
  const auto representative = surface_->representative();
  const std::vector<Vec3> normals = vertex_normals(after, triangles);
  std::vector<char> folded(after.size(), 0);
  parallel_for(after.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (absent[v] != 0 || at(representative[v]) != v || normals[v] == Vec3::Zero()) continue;
      if (stays_[at(part_of_vertex_[v])] != 0) continue;
      const Vec3 &p = after[v], &along = normals[v];
      larger.for_each_near(part_of_vertex_[v], p, p + room_ * along, [&](int index) {
        const Triangle& t = triangles[at(index)];
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

}  // namespace ft::inline collision

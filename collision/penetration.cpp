// See penetration.h.
#include "collision/penetration.h"

#include <algorithm>
#include <cmath>

#include "baker/core/disjoint_sets.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

/// Signed crossings of a ray: leaving counts +1, entering -1; positive when the ray starts inside.
int winding(const TriangleTree& tree, const Vec3& p, const Vec3& direction, std::span<const Vec3> x,
            std::span<const Triangle> triangles) {
  int sum = 0;
  tree.for_each_along(p, direction, std::numeric_limits<double>::infinity(), [&](int i) {
    const Triangle& t = triangles[static_cast<std::size_t>(i)];
    const Vec3& a = x[static_cast<std::size_t>(t[0])];
    const Vec3 e = x[static_cast<std::size_t>(t[1])] - a, f = x[static_cast<std::size_t>(t[2])] - a, s = p - a;
    const Vec3 h = direction.cross(f);
    const double determinant = e.dot(h);
    if (determinant == 0) return;
    const double u = s.dot(h) / determinant;
    const Vec3 q = s.cross(e);
    const double v = direction.dot(q) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || !(f.dot(q) / determinant > 0)) return;
    sum += e.cross(f).dot(direction) > 0 ? 1 : -1;
  });
  return sum;
}

}  // namespace

bool is_inside(const Vec3& p, std::span<const Vec3> surface, std::span<const Triangle> triangles,
               const TriangleTree& tree) {
  static const Vec3 directions[3] = {Vec3(0.577, 0.61, 0.543).normalized(), Vec3(-0.31, 0.88, 0.36).normalized(),
                                     Vec3(0.23, -0.41, -0.88).normalized()};
  int votes = 0;
  for (int k = 0; k < 3 && votes < 2 && votes + 3 - k >= 2; ++k)
    votes += winding(tree, p, directions[k], surface, triangles) > 0 ? 1 : 0;
  return votes >= 2;
}

std::vector<Penetration> penetrations(std::span<const Vec3> points, const CheckedSurface& checked, double least_depth) {
  std::vector<Penetration> out;
  if (points.empty() || checked.empty()) return out;
  const std::span<const Vec3> surface = checked.positions();
  const std::span<const Triangle> triangles = checked.triangles();
  const TriangleTree& tree = checked.tree();
  std::vector<double> depth(points.size(), 0.0);
  parallel_for(points.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (tree.box().squared_distance(points[i]) > 0) continue;
      if (!is_inside(points[i], surface, triangles, tree)) continue;
      TriangleTree::Hit hit;
      tree.closest(points[i], surface, triangles, hit);
      depth[i] = std::sqrt(hit.closest.squared_distance);
    }
  });
  for (std::size_t i = 0; i < points.size(); ++i)
    if (depth[i] > least_depth) out.push_back({static_cast<int>(i), depth[i]});
  return out;
}

std::vector<Penetration> penetrations(std::span<const Vec3> points, std::span<const Vec3> surface,
                                      std::span<const Triangle> triangles, double least_depth) {
  CheckedSurface checked(triangles);
  checked.move(surface);
  return penetrations(points, checked, least_depth);
}

std::vector<Penetration> penetrations(std::span<const Vec3> points, std::span<const Edge> edges,
                                      std::span<const Crossing> crossings, const CheckedSurface& surface,
                                      double least_depth) {
  if (!surface.closed()) return penetrations(points, surface, least_depth);
  std::vector<Edge> crossing;
  for (const Crossing& c : crossings)
    if (c.edge_of_first) crossing.push_back({std::min(c.edge[0], c.edge[1]), std::max(c.edge[0], c.edge[1])});
  std::sort(crossing.begin(), crossing.end());
  DisjointSets on_one_side(points.size());
  for (const Edge& e : edges) {
    if (std::binary_search(crossing.begin(), crossing.end(), e)) continue;
    on_one_side.join(e[0], e[1]);
  }
  const auto places_of = [&](const std::vector<int>& chosen) {
    std::vector<Vec3> places;
    for (const int v : chosen) places.push_back(points[at(v)]);
    return places;
  };
  std::vector<int> roots, chosen;
  for (int v = 0; v < static_cast<int>(points.size()); ++v)
    if (on_one_side.root(v) == v) roots.push_back(v);
  std::vector<char> inside(points.size(), 0);  // at the root
  for (const Penetration& p : penetrations(places_of(roots), surface, 0)) inside[at(roots[at(p.vertex)])] = 1;
  for (int v = 0; v < static_cast<int>(points.size()); ++v)
    if (inside[at(on_one_side.root(v))] != 0) chosen.push_back(v);
  std::vector<Penetration> out = penetrations(places_of(chosen), surface, least_depth);
  for (Penetration& p : out) p.vertex = chosen[at(p.vertex)];
  return out;
}

}  // namespace ft

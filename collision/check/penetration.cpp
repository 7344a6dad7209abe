// See penetration.h.
#include "collision/check/penetration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "baker/core/disjoint_sets.h"
#include "baker/core/parallel.h"
#include "collision/geometry/winding_number.h"

namespace ft::inline collision {
namespace {

/// Signed crossings of a ray: leaving counts +1, entering -1; the winding number where it starts.
int winding_along(const Vec3& direction, const Vec3& p, const TriangleTree& tree, std::span<const Vec3> x,
                  std::span<const Triangle> triangles) {
  int sum = 0;
  tree.for_each_along(p, direction, std::numeric_limits<double>::infinity(), [&](int i) {
    const Triangle& t = triangles[at(i)];
    const Vec3& a = x[at(t[0])];
    const Vec3 e = x[at(t[1])] - a, f = x[at(t[2])] - a, s = p - a;
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

const std::array<Vec3, 3>& rays() {
  static const std::array<Vec3, 3> directions{Vec3(0.577, 0.61, 0.543).normalized(),
                                              Vec3(-0.31, 0.88, 0.36).normalized(),
                                              Vec3(0.23, -0.41, -0.88).normalized()};
  return directions;
}

/// Of a closed surface, whose winding numbers are whole: every ray tells. Two of three have to agree, so that none that
/// runs along an edge decides.
bool is_inside_closed(const Vec3& p, const TriangleTree& tree, std::span<const Vec3> surface,
                      std::span<const Triangle> triangles) {
  int votes = 0;
  for (int k = 0; k < 3 && votes < 2 && votes + 3 - k >= 2; ++k)
    votes += winding_along(rays()[at(k)], p, tree, surface, triangles) != 0 ? 1 : 0;
  return votes >= 2;
}

/// Of open shells a ray only says that there is something to ask: where all three leave as if there were nothing, there
/// is nothing. That spares most of the cloth the question, which costs more than its rays.
bool is_inside_open(const Vec3& p, const CheckedSurface& surface, const WindingTree& winding) {
  const auto sees_something = [&](const Vec3& ray) {
    return winding_along(ray, p, surface.tree(), surface.positions(), surface.triangles()) != 0;
  };
  return std::any_of(rays().begin(), rays().end(), sees_something) && winding.is_inside(p);
}

}  // namespace

bool rays_say_inside(const Vec3& p, const TriangleTree& tree, std::span<const Vec3> surface,
                     std::span<const Triangle> triangles) {
  return is_inside_closed(p, tree, surface, triangles);
}

std::vector<Penetration> penetrations(std::span<const Vec3> points, const CheckedSurface& surface, double least_depth) {
  std::vector<Penetration> out;
  if (points.empty() || surface.empty()) return out;
  const TriangleTree& tree = surface.tree();
  const auto in_reach = [&](const Vec3& p) { return !(tree.box().squared_distance(p) > 0); };
  std::optional<WindingTree> winding;
  if (!surface.closed() && std::any_of(points.begin(), points.end(), in_reach))
    winding.emplace(tree, surface.positions(), surface.triangles());
  std::vector<double> depth(points.size(), 0.0);
  parallel_for(points.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!in_reach(points[i])) continue;
      const bool inside = winding ? is_inside_open(points[i], surface, *winding)
                                  : is_inside_closed(points[i], tree, surface.positions(), surface.triangles());
      if (!inside) continue;
      TriangleTree::Hit hit;
      tree.closest(points[i], surface.positions(), surface.triangles(), hit);
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

}  // namespace ft::inline collision

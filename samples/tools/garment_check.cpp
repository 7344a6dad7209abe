#include "samples/tools/garment_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::garments {
namespace {

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto volume = [](const Vec3& u, const Vec3& v, const Vec3& w, const Vec3& x) {
    return (v - u).cross(w - u).dot(x - u);
  };
  const double sp = volume(a, b, c, p), sq = volume(a, b, c, q);
  if ((sp > 0) == (sq > 0)) return false;
  const double s0 = volume(p, q, a, b), s1 = volume(p, q, b, c), s2 = volume(p, q, c, a);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

/// Triangles sorted into slabs along y: enough for a few ten thousand triangles.
int edges_through(std::span<const Vec3> a, std::span<const Triangle> a_triangles, std::span<const Vec3> b,
                  std::span<const Triangle> b_triangles) {
  const Box box = bounds(b);
  const int count = 256;
  const double height = std::max(1e-9, box.size().y()) / count;
  const auto slab = [&](double y) { return std::clamp(static_cast<int>((y - box.lo.y()) / height), 0, count - 1); };
  std::vector<std::vector<int>> slabs(at(count));
  std::vector<Box> boxes(b_triangles.size());
  for (int t = 0; t < static_cast<int>(b_triangles.size()); ++t) {
    for (const int v : b_triangles[at(t)]) boxes[at(t)].include(b[at(v)]);
    for (int k = slab(boxes[at(t)].lo.y()); k <= slab(boxes[at(t)].hi.y()); ++k) slabs[at(k)].push_back(t);
  }
  int crossings = 0;
  std::vector<int> seen(b_triangles.size(), -1);
  int number = 0;
  for (const Edge& edge : unique_edges(a_triangles)) {
    ++number;
    Box reach;
    reach.include(a[at(edge[0])]), reach.include(a[at(edge[1])]);
    if (!reach.overlaps(box)) continue;
    for (int k = slab(reach.lo.y()); k <= slab(reach.hi.y()); ++k)
      for (const int t : slabs[at(k)]) {
        if (seen[at(t)] == number || !boxes[at(t)].overlaps(reach)) continue;
        seen[at(t)] = number;
        const Triangle& f = b_triangles[at(t)];
        if (segment_meets_triangle(a[at(edge[0])], a[at(edge[1])], b[at(f[0])], b[at(f[1])], b[at(f[2])])) ++crossings;
      }
  }
  return crossings;
}

}  // namespace

int count_crossings(std::span<const Vec3> a, std::span<const Triangle> a_triangles, std::span<const Vec3> b,
                    std::span<const Triangle> b_triangles) {
  return edges_through(a, a_triangles, b, b_triangles) + edges_through(b, b_triangles, a, a_triangles);
}

ShapeQuality shape_quality(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::vector<double> edges, angles;
  for (const Edge& e : unique_edges(triangles)) edges.push_back((positions[at(e[0])] - positions[at(e[1])]).norm());
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = positions[at(t[at((k + 1) % 3)])] - positions[at(t[at(k)])],
                 v = positions[at(t[at((k + 2) % 3)])] - positions[at(t[at(k)])];
      angles.push_back(std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(angles.begin(), angles.end());
  if (edges.empty()) return {};
  return {edges.front(), edges[edges.size() / 2], edges.back(), angles.front(), angles[angles.size() / 100]};
}

}  // namespace ft::garments

// The point of a surface that is nearest to a place, by looking at every triangle: for what is set up once.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "collision/geometry/pair_geometry.h"

namespace ft::inline collision {

struct SurfacePoint {
  Triangle triangle{-1, -1, -1};                              ///< -1: there is none
  std::array<double, 3> weight{};                             ///< barycentric
  double distance = std::numeric_limits<double>::infinity();  ///< m
};

/// Among the triangles for which counts(triangle, distance) is true; of equally near ones the first.
template <class Counts>
SurfacePoint nearest_point(const Vec3& place, std::span<const Vec3> x, std::span<const Triangle> triangles,
                           Counts&& counts) {
  SurfacePoint out;
  for (const Triangle& t : triangles) {
    const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
    // Cheap rejection: no point of the triangle is nearer than its first corner less its longest side.
    const double reach = std::max((b - a).norm(), (c - a).norm());
    if ((place - a).norm() - reach > out.distance) continue;
    const PairGeometry g = vertex_face_geometry(place, a, b, c);
    if (g.distance >= out.distance || !counts(t, g.distance)) continue;
    out = {t, {-g.weight[1], -g.weight[2], -g.weight[3]}, g.distance};
  }
  return out;
}

inline SurfacePoint nearest_point(const Vec3& place, std::span<const Vec3> x, std::span<const Triangle> triangles) {
  return nearest_point(place, x, triangles, [](const Triangle&, double) { return true; });
}

}  // namespace ft::inline collision

// The skin that is nearest to a place. Part of absence.cpp and the files beside it.
#pragma once

#include <span>
#include <vector>

#include "collision/geometry/triangle_tree.h"

namespace ft::inline solvers::absent {

/// What stays away around a place where cloth crosses, or is inside of, what would come back [m].
inline constexpr double k_margin = 0.025;
/// How deep inside cloth is looked for [m].
inline constexpr double k_deepest = 0.2;

/// Cloth that was put on lies no farther from the skin [m].
inline constexpr double k_on_skin = 0.05;

struct Nearest {
  int triangle = -1;
  double distance = 0;  ///< m
  Vec3 way_out;         ///< unit, from the point to the surface; zero on it
  bool behind = false;  ///< of the triangle
};

inline Nearest nearest(const Vec3& p, std::span<const Vec3> body, std::span<const Triangle> triangles,
                       const TriangleTree& tree, double reach) {
  TriangleTree::Hit hit;
  hit.closest.squared_distance = reach * reach;
  tree.closest(p, body, triangles, hit);
  Nearest out;
  out.triangle = hit.triangle;
  out.way_out.setZero();
  if (hit.triangle < 0) return out;
  const Triangle& t = triangles[at(hit.triangle)];
  const Vec3 way = hit.closest.point - p;
  out.distance = way.norm();
  if (out.distance > 0) out.way_out = way / out.distance;
  out.behind = (body[at(t[1])] - body[at(t[0])]).cross(body[at(t[2])] - body[at(t[0])]).dot(way) > 0;
  return out;
}

/// Of the triangles that are wanted.
template <class Wanted>
TriangleTree tree_of(std::span<const Vec3> x, std::span<const Triangle> triangles, Wanted&& wanted) {
  std::vector<int> subset;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    if (wanted(triangles[at(t)])) subset.push_back(t);
  return TriangleTree(x, triangles, std::move(subset));
}

inline Vec3 normal_of(const Triangle& t, std::span<const Vec3> x) {
  return (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).normalized();
}

}  // namespace ft::inline solvers::absent

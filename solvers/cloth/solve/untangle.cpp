#include "solvers/cloth/solve/untangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// Of a vertex in a tangle [m/s2]: five times what gravity presses layers together with.
constexpr double k_push = 50;
/// An edge nearer to the face's plane than this (sine of the angle) says nothing about which way shortens.
constexpr double k_flat = 1e-6;
/// The contour's shortening by a unit of motion that is less than this is rounding: the pulls of both sides are in
/// balance.
constexpr double k_balanced = 1e-9;

struct EdgeSide {
  Edge edge;
  int opposite;
  auto operator<=>(const EdgeSide&) const = default;
};

std::vector<EdgeSide> edge_sides(std::span<const Triangle> triangles) {
  std::vector<EdgeSide> out;
  out.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      out.push_back({{std::min(a, b), std::max(a, b)}, t[(k + 2) % 3]});
    }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

void untangling(std::span<const Vec3> x, std::span<const Triangle> triangles, std::span<const Crossing> crossings,
                std::span<Vec3> acceleration) {
  std::fill(acceleration.begin(), acceleration.end(), Vec3::Zero());
  if (crossings.empty()) return;
  const std::vector<EdgeSide> sides = edge_sides(triangles);
  std::vector<double> weight_sum(x.size(), 0.0);
  for (const Crossing& c : crossings) {
    const Vec3 &p = x[at(c.edge[0])], &q = x[at(c.edge[1])];
    const Vec3 &a = x[at(c.triangle[0])], &b = x[at(c.triangle[1])], &d = x[at(c.triangle[2])];
    const Vec3 normal = (b - a).cross(d - a).normalized(), along = (q - p).normalized();
    const double across = along.dot(normal);
    if (!(std::abs(across) > k_flat) || !normal.allFinite()) continue;
    // The contour leaves the edge into each of its faces; moving the edge by m shortens it by m . (sum of way_in - 2
    // (E.way_in)/(E.N) N).
    Vec3 shorter = Vec3::Zero();
    const Edge key{std::min(c.edge[0], c.edge[1]), std::max(c.edge[0], c.edge[1])};
    for (auto side = std::lower_bound(sides.begin(), sides.end(), EdgeSide{key, -1});
         side != sides.end() && side->edge == key; ++side) {
      const Vec3 to_opposite = x[at(side->opposite)] - p;
      const Vec3 inwards = to_opposite - to_opposite.dot(along) * along;
      Vec3 way_in = along.cross(inwards).cross(normal);
      if (way_in.dot(inwards) < 0) way_in = -way_in;
      const double length = way_in.norm();
      if (length > 0) way_in /= length;
      shorter += way_in - 2 * (along.dot(way_in) / across) * normal;
    }
    const double size = shorter.norm();
    if (!(size > k_balanced) || !std::isfinite(size)) continue;
    const Vec3 push = k_push / size * shorter;
    // Where the edge goes through the face, and which vertices hold that place.
    const double s = std::clamp((a - p).dot(normal) / (q - p).dot(normal), 0.0, 1.0);
    const Vec3 place = p + s * (q - p);
    const double area = (b - a).cross(d - a).dot(normal);
    const double wb = (place - a).cross(d - a).dot(normal) / area, wd = (b - a).cross(place - a).dot(normal) / area;
    const std::array<int, 5> vertex{c.edge[0], c.edge[1], c.triangle[0], c.triangle[1], c.triangle[2]};
    const std::array<double, 5> weight{1 - s, s, -(1 - wb - wd), -wb, -wd};
    for (std::size_t k = 0; k < 5; ++k) {
      acceleration[at(vertex[k])] += weight[k] * push;
      weight_sum[at(vertex[k])] += std::abs(weight[k]);
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    if (weight_sum[i] > 1) acceleration[i] /= weight_sum[i];
}

}  // namespace ft::inline solvers

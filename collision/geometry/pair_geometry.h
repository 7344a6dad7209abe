// Closest points of a vertex-face or an edge-edge pair, in double, with a stated answer for degenerate features
// (Ericson 2005, chapter 5). The offset vector is p_first - p_second = sum weight[i] * x[i].
//
// Degenerate features: a face without area is its three edges, an edge without length is a point; parallel edges answer
// with a closest pair that has an end point in it. Caution: closeness decides between candidates, so the answer is
// never farther than a true closest pair by more than rounding, but which of several equally close pairs is given is
// not specified.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "baker/core/types.h"

namespace ft::inline collision {

enum class PairKind { k_vertex_face, k_edge_edge };

struct PairGeometry {
  double distance = 0;  ///< m
  Vec3 normal =
      Vec3::Zero();  ///< unit, from the second feature (face, second edge) to the first; zero if distance is 0
  std::array<double, 4> weight{};  ///< vertex-face: 1, -u, -v, -w; edge-edge: 1-s, s, -(1-t), -t
  bool interior = false;  ///< closest points inside both features (face interior; both edge parameters in (0,1))
};

PairGeometry vertex_face_geometry(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
PairGeometry edge_edge_geometry(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// Either of the two, on the vertices of a stencil.
inline PairGeometry pair_geometry(PairKind kind, const std::array<Vec3, 4>& x) {
  return kind == PairKind::k_vertex_face ? vertex_face_geometry(x[0], x[1], x[2], x[3])
                                         : edge_edge_geometry(x[0], x[1], x[2], x[3]);
}

/// How many of the four vertices belong to the first feature.
constexpr int first_feature_size(PairKind kind) {
  return kind == PairKind::k_vertex_face ? 1 : 2;
}

/// Squared distance between the boxes of the two features: a lower bound that is cheaper than theirs [m2].
inline double box_gap_squared(PairKind kind, const std::array<Vec3, 4>& x) {
  const auto split = static_cast<std::size_t>(first_feature_size(kind));
  Vec3 lo_a = x[0], hi_a = x[0], lo_b = x[split], hi_b = x[split];
  for (std::size_t k = 1; k < split; ++k) lo_a = lo_a.cwiseMin(x[k]), hi_a = hi_a.cwiseMax(x[k]);
  for (std::size_t k = split + 1; k < 4; ++k) lo_b = lo_b.cwiseMin(x[k]), hi_b = hi_b.cwiseMax(x[k]);
  return (lo_a - hi_b).cwiseMax(lo_b - hi_a).cwiseMax(0.0).squaredNorm();
}

/// The normal of a face, or across both edges; not of unit length, zero where there is none.
inline Vec3 flat_normal(PairKind kind, const std::array<Vec3, 4>& x) {
  return kind == PairKind::k_vertex_face ? (x[2] - x[1]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[3] - x[2]);
}

/// Largest motion of a vertex of one feature relative to a vertex of the other, for displacements d [m].
inline double largest_relative_motion(PairKind kind, const std::array<Vec3, 4>& d) {
  const auto split = static_cast<std::size_t>(first_feature_size(kind));
  double squared = 0;
  for (std::size_t a = 0; a < split; ++a)
    for (std::size_t b = split; b < 4; ++b) squared = std::max(squared, (d[a] - d[b]).squaredNorm());
  return std::sqrt(squared);
}

/// Width of the slab across geometry.normal that has the first feature on one side and the second on the other [m];
/// negative when there is none. A lower bound of the true distance for any normal, so it is proof where the closest
/// points are only an answer (slivers).
double separation(PairKind kind, const std::array<Vec3, 4>& x, const PairGeometry& geometry);

/// True when all vertices really lie on their sides, at least floor [m] apart.
inline bool separates(PairKind kind, const std::array<Vec3, 4>& x, const PairGeometry& geometry, double floor) {
  return separation(kind, x, geometry) >= floor;
}

}  // namespace ft::inline collision

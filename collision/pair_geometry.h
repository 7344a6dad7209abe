// Closest points of a vertex-face or an edge-edge pair, in double, with a stated answer for degenerate features
// (Ericson 2005, chapter 5). The offset vector is p_first - p_second = sum weight[i] * x[i].
#pragma once

#include <array>

#include "baker/core/types.h"

namespace ft {

struct PairGeometry {
  double distance = 0;                 ///< m
  Vec3 normal = Vec3::Zero();          ///< unit, from the second feature (face, second edge) to the first; zero if distance is 0
  std::array<double, 4> weight{};      ///< vertex-face: 1, -u, -v, -w; edge-edge: 1-s, s, -(1-t), -t
  bool interior = false;               ///< closest points inside both features (face interior; both edge parameters in (0,1))
};

PairGeometry vertex_face_geometry(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
PairGeometry edge_edge_geometry(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

}  // namespace ft

// Curvature of a triangle from the angles theta_i at its edges:
//   kappa = sum_i theta_i l_i / (A + A_i) t_i t_i^T
//   l_i: edge length; t_i: its in-plane normal; A_i: area of the triangle beyond it
// which is exact for sheets bent on regular meshes of any direction (the rotation-free shell triangle of Onate and
// Zarate 2000, with the angle shared between the two triangles in proportion to their heights). Energy A/2
// kappa.D.kappa with D from the bending rigidities of weft and warp; no Poisson effect in bending. The single-hinge
// energy 3 B |e|^2 / (A1 + A2) theta^2 / 2 common in graphics (Grinspun et al. 2003) has a stiffness that depends on
// the direction of the edges: measured here from 0.8 to 3 times B on grids, after dividing out its factor 3.
// At a free edge the angle is whatever costs least: it is eliminated, which leaves no moment there.
#include "solvers/energies/cloth_topology_bending.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

struct EdgeUse {
  Edge edge;
  int triangle;
  int opposite;
  bool operator<(const EdgeUse& o) const { return edge != o.edge ? edge < o.edge : triangle < o.triangle; }
};

}  // namespace

void add_hinges(ClothTopology& out) {
  // Sorted by edge: independent of the order of the triangles. An edge of more than two triangles (a pocket, a seam
  // sewn flat) gets a hinge for each consecutive pair.
  std::vector<EdgeUse> uses;
  uses.reserve(3 * out.triangles.size());
  for (std::size_t t = 0; t < out.triangles.size(); ++t) {
    if (out.rest_area[t] == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = out.triangles[t][k], b = out.triangles[t][(k + 1) % 3];
      uses.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(t), out.triangles[t][(k + 2) % 3]});
    }
  }
  std::sort(uses.begin(), uses.end());
  for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
    const EdgeUse &u = uses[i], &w = uses[i + 1];
    if (u.edge != w.edge || u.opposite == w.opposite) continue;
    const Triangle& first = out.triangles[at(u.triangle)];
    Hinge hinge;
    hinge.vertex = {u.edge[0], u.edge[1], u.opposite, w.opposite};
    for (std::size_t k = 0; k < 3; ++k)
      if (first[k] == u.edge[1] && first[(k + 1) % 3] == u.edge[0]) std::swap(hinge.vertex[0], hinge.vertex[1]);
    const auto& v = hinge.vertex;
    hinge.piece = out.triangle_piece[at(u.triangle)];
    hinge.rest_area = out.rest_area[at(u.triangle)] + out.rest_area[at(w.triangle)];
    if (!(out.pieces[at(hinge.piece)].pattern_scale > 0))
      hinge.rest_angle = hinge_angle(out.rest[at(v[0])], out.rest[at(v[1])], out.rest[at(v[2])], out.rest[at(v[3])]);
    hinge.triangle = {u.triangle, w.triangle};
    out.hinges.push_back(hinge);
  }
}

void add_bend_elements(ClothTopology& out) {
  std::vector<BendElement> elements(out.triangles.size());
  for (std::size_t h = 0; h < out.hinges.size(); ++h) {
    const Hinge& hinge = out.hinges[h];
    for (const int t : hinge.triangle) {
      const Triangle& tri = out.triangles[at(t)];
      for (std::size_t k = 0; k < 3; ++k) {
        const int c = tri[(k + 1) % 3], d = tri[(k + 2) % 3];
        const bool same = c == hinge.vertex[0] && d == hinge.vertex[1],
                   reversed = c == hinge.vertex[1] && d == hinge.vertex[0];
        if ((!same && !reversed) || elements[at(t)].hinge[k] >= 0) continue;
        elements[at(t)].hinge[k] = static_cast<int>(h);
        // The first triangle runs along the hinge; a second one that does too looks the other way.
        elements[at(t)].sign[k] = t == hinge.triangle[0] || reversed ? 1 : -1;
      }
    }
  }
  for (std::size_t t = 0; t < elements.size(); ++t) {
    BendElement& element = elements[t];
    const Fabric& fabric = out.fabric_of_triangle(t);
    if (out.rest_area[t] == 0 || (fabric.bend_warp <= 0 && fabric.bend_weft <= 0)) continue;
    element.triangle = static_cast<int>(t);
    // Corners in material axes: columns of the inverse of rest_inverse.
    const auto& r = out.rest_inverse[t];
    const double det = r[0] * r[3] - r[1] * r[2];
    const Vec2 corner[3] = {Vec2::Zero(), Vec2(r[3], -r[2]) / det, Vec2(-r[1], r[0]) / det};
    Mat3 modes = Mat3::Zero();  // column k: (k11, k22, 2 k12) per radian at edge k
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 edge = corner[(k + 2) % 3] - corner[(k + 1) % 3];
      const double length = edge.norm();
      const Vec2 normal(-edge.y() / length, edge.x() / length);
      const int h = element.hinge[k];
      const double share = length / (h >= 0 ? out.hinges[at(h)].rest_area : 2 * out.rest_area[t]);
      modes.col(static_cast<int>(k)) =
          share * Vec3(normal.x() * normal.x(), normal.y() * normal.y(), 2 * normal.x() * normal.y());
    }
    Mat3 rigidity = Mat3::Zero();
    rigidity(0, 0) = fabric.bend_weft, rigidity(1, 1) = fabric.bend_warp;
    rigidity(2, 2) = 0.5 * std::sqrt(fabric.bend_weft * fabric.bend_warp);
    rigidity *= out.factor(t, &VertexMaps::bend);
    Mat3 m = out.rest_area[t] * modes.transpose() * rigidity * modes;
    for (int k = 0; k < 3; ++k)
      if (element.hinge[at(k)] < 0) {  // eliminate the free edge
        const Vec3 column = m.col(k);
        const double pivot = column[k];
        if (pivot > 0) m -= column * column.transpose() / pivot;
        m.row(k).setZero();
        m.col(k).setZero();
      }
    element.stiffness = 0.5 * (m + m.transpose());
    if (element.hinge[0] >= 0 || element.hinge[1] >= 0 || element.hinge[2] >= 0) out.bends.push_back(element);
  }
}

}  // namespace ft::inline solvers

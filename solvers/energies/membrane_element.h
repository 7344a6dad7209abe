// One group of triangles of the membrane: deformation, strain, stress and the blocks of its matrix, k_lanes at a time.
// Part of membrane.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "solvers/energies/block_scatter.h"
#include "solvers/energies/membrane.h"

namespace ft::inline solvers::membrane {

using Lane = double[k_lanes];

/// Two edges and the deformation gradient F = (f1 f2) of a group.
struct Deformation {
  alignas(32) Lane f1[3], f2[3];
};

inline void deformation(const Membrane::Vertices& v, const Membrane::Group& g, std::span<const Vec3> x,
                        Deformation& out) {
  alignas(32) Lane e1[3], e2[3];
  for (int l = 0; l < k_lanes; ++l) {
    const Vec3 &x0 = x[at(v.column[0][l])], &x1 = x[at(v.column[1][l])], &x2 = x[at(v.column[2][l])];
    for (int k = 0; k < 3; ++k) e1[k][l] = x1[k] - x0[k], e2[k][l] = x2[k] - x0[k];
  }
  const auto& r = g.rest_inverse;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < k_lanes; ++l) {
      out.f1[k][l] = e1[k][l] * r[0][l] + e2[k][l] * r[2][l];
      out.f2[k][l] = e1[k][l] * r[1][l] + e2[k][l] * r[3][l];
    }
}

/// Green strain E11, E22, 2 E12.
inline void strain(const Deformation& d, Lane* e) {
  for (int l = 0; l < k_lanes; ++l) {
    const double a0 = d.f1[0][l], a1 = d.f1[1][l], a2 = d.f1[2][l];
    const double b0 = d.f2[0][l], b1 = d.f2[1][l], b2 = d.f2[2][l];
    e[0][l] = 0.5 * (a0 * a0 + a1 * a1 + a2 * a2 - 1);
    e[1][l] = 0.5 * (b0 * b0 + b1 * b1 + b2 * b2 - 1);
    e[2][l] = a0 * b0 + a1 * b1 + a2 * b2;
  }
}

/// Strain over which the crimp goes out of yarns and their stiffness comes in [1].
inline constexpr double k_straightening = 0.01;
/// Shear over which yarns that begin to press against each other sideways jam [1]: flat where they meet, they give way.
inline constexpr double k_jamming = 0.05;

struct Taut {
  double value, slope, curvature;
};

/// Energy of unit stiffness at a strain past the limit: its curvature rises from 0 to 1 over w, without a jump.
inline Taut taut(double past, double w = k_straightening) {
  const double in = std::clamp(past, 0.0, w), out = std::max(past - w, 0.0);
  return {in * in * in / (6 * w) + out * (0.5 * w + 0.5 * out), in * in / (2 * w) + out, in / w};
}

/// The same of a shear to either side.
inline Taut jammed(double shear, double limit) {
  Taut out = taut(std::abs(shear) - limit, k_jamming);
  out.slope = std::copysign(out.slope, shear);
  return out;
}

/// Materials of a group, times area where they are stiffnesses [N m].
struct Constants {
  alignas(32) Lane stiffness[4], damping_time, limit[3], limit_stiffness, jam_stiffness;
};

inline void constants(const Membrane::Group& g, const std::uint16_t* material,
                      std::span<const Membrane::Material> materials, Constants& out) {
  for (int l = 0; l < k_lanes; ++l) {
    const Membrane::Material& m = materials[material[l]];
    for (int k = 0; k < 4; ++k) out.stiffness[k][l] = g.area[l] * m.stiffness[k];
    out.damping_time[l] = m.damping_time;
    for (int k = 0; k < 3; ++k) out.limit[k][l] = m.limit[k];
    out.limit_stiffness[l] = g.area[l] * m.limit_stiffness;
    out.jam_stiffness[l] = g.area[l] * m.jam_stiffness;
  }
}

/// Area times second Piola-Kirchhoff stress with damping: S11, S22, S12.
inline void stress(const Constants& c, const Membrane::Reference& ref, double inverse_rate_time, const Lane* e,
                   Lane* s) {
  for (int l = 0; l < k_lanes; ++l) {
    const double d = c.damping_time[l] * inverse_rate_time;
    const double e0 = e[0][l] + d * (e[0][l] - ref.strain[0][l]);
    const double e1 = e[1][l] + d * (e[1][l] - ref.strain[1][l]);
    const double e2 = e[2][l] + d * (e[2][l] - ref.strain[2][l]);
    s[0][l] =
        c.stiffness[0][l] * e0 + c.stiffness[2][l] * e1 + c.limit_stiffness[l] * taut(e[0][l] - c.limit[0][l]).slope;
    s[1][l] =
        c.stiffness[2][l] * e0 + c.stiffness[1][l] * e1 + c.limit_stiffness[l] * taut(e[1][l] - c.limit[1][l]).slope;
    s[2][l] = c.stiffness[3][l] * e2 + c.jam_stiffness[l] * jammed(e[2][l], c.limit[2][l]).slope;
  }
}

inline Lanes as_lanes(const Lane& values) {
  Lanes out;
  for (int l = 0; l < k_lanes; ++l) out[l] = static_cast<float>(values[l]);
  return out;
}

/// Blocks (1,1), (1,2), (2,2) of the element matrix, column by column; the others follow from its rows summing to zero.
struct ElementBlocks {
  Lanes b11[9], b12[9], b22[9];
};

/// What the blocks are made of: F = (u w), area times stiffness c with damping, positive part p of area times stress.
struct ElementParts {
  Lanes u[3], w[3], c11, c22, c12, c33, p11, p22, p12;
};

/// Block (a, b) = F M_ab F^T + s_ab I, where M_ab holds the shape gradients (ax, ay), (bx, by) and the stiffness,
/// s_ab = (ax, ay) . S+ (bx, by).
inline void element_block(const ElementParts& e, const Lanes& ax, const Lanes& ay, const Lanes& bx, const Lanes& by,
                          Lanes* out) {
  const Lanes xx = ax * bx, yy = ay * by, xy = ax * by, yx = ay * bx;
  const Lanes m11 = e.c11 * xx + e.c33 * yy, m22 = e.c22 * yy + e.c33 * xx;
  const Lanes m12 = e.c12 * xy + e.c33 * yx, m21 = e.c12 * yx + e.c33 * xy;
  const Lanes sab = e.p11 * xx + e.p22 * yy + e.p12 * (xy + yx);
  for (int column = 0; column < 3; ++column) {
    const Lanes h = m11 * e.u[column] + m12 * e.w[column], k = m21 * e.u[column] + m22 * e.w[column];
    for (int row = 0; row < 3; ++row) out[3 * column + row] = e.u[row] * h + e.w[row] * k;
    out[4 * column] += sab;
  }
}

inline void element_blocks(const Membrane::Group& g, const Constants& c, const Deformation& d, const Lane* strain,
                           const Lane* s, double inverse_rate_time, ElementBlocks& out) {
  // Positive part of the 2x2 stress: alpha S + beta I, from the eigenvalues mean +- radius.
  alignas(32) Lane p[3], more, straight[3];
  for (int l = 0; l < k_lanes; ++l) {
    const double mean = 0.5 * (s[0][l] + s[1][l]), half = 0.5 * (s[0][l] - s[1][l]);
    const double radius = std::sqrt(half * half + s[2][l] * s[2][l]);
    const double l1 = mean + radius, l2 = mean - radius;
    const double q1 = l1 > 0 ? l1 : 0, q2 = l2 > 0 ? l2 : 0;
    const double twice = 2 * radius > 1e-100 ? 2 * radius : 1e-100;
    const double alpha = (q1 - q2) / twice, beta = q1 - alpha * l1;
    p[0][l] = alpha * s[0][l] + beta, p[1][l] = alpha * s[1][l] + beta, p[2][l] = alpha * s[2][l];
    more[l] = 1 + c.damping_time[l] * inverse_rate_time;
    for (int k = 0; k < 2; ++k) straight[k][l] = c.limit_stiffness[l] * taut(strain[k][l] - c.limit[k][l]).curvature;
    straight[2][l] = c.jam_stiffness[l] * jammed(strain[2][l], c.limit[2][l]).curvature;
  }
  ElementParts e;
  for (int k = 0; k < 3; ++k) e.u[k] = as_lanes(d.f1[k]), e.w[k] = as_lanes(d.f2[k]);
  const Lanes factor = as_lanes(more);
  e.c11 = factor * as_lanes(c.stiffness[0]) + as_lanes(straight[0]);
  e.c22 = factor * as_lanes(c.stiffness[1]) + as_lanes(straight[1]);
  e.c12 = factor * as_lanes(c.stiffness[2]);
  e.c33 = factor * as_lanes(c.stiffness[3]) + as_lanes(straight[2]);
  e.p11 = as_lanes(p[0]), e.p22 = as_lanes(p[1]), e.p12 = as_lanes(p[2]);
  const Lanes ax = as_lanes(g.rest_inverse[0]), ay = as_lanes(g.rest_inverse[1]);
  const Lanes bx = as_lanes(g.rest_inverse[2]), by = as_lanes(g.rest_inverse[3]);
  element_block(e, ax, ay, ax, ay, out.b11);
  element_block(e, ax, ay, bx, by, out.b12);
  element_block(e, bx, by, bx, by, out.b22);
}

/// Adds the six blocks of the `used` elements of a group that lie on and above the diagonal.
inline void scatter(ElementBlocks& e, const Membrane::Vertices& vertices, const BlockPositions<3>& positions,
                    std::size_t group, std::size_t used, BlockMatrix& matrix) {
  Lanes b00[9], b01[9], b02[9];
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = 0; row < 3; ++row) {
      const std::size_t k = 3 * column + row, transposed = 3 * row + column;
      b01[k] = -(e.b11[k] + e.b12[transposed]);
      b02[k] = -(e.b12[k] + e.b22[k]);
    }
  for (std::size_t k = 0; k < 9; ++k) b00[k] = -(b01[k] + b02[k]);
  LaneInts vertex[3], diagonal[3];
  for (std::size_t a = 0; a < 3; ++a) {
    std::memcpy(&vertex[a], &vertices.column[a], sizeof vertex[a]);
    diagonal[a] = diagonal_places(matrix.pattern->diagonal, vertex[a]);
  }
  transpose_where(vertex[0] > vertex[1], b01);
  transpose_where(vertex[0] > vertex[2], b02);
  transpose_where(vertex[1] > vertex[2], e.b12);
  const auto add = [&](const Lanes* block, std::size_t a, std::size_t b) {
    add_blocks(block, used, matrix.blocks.data(),
               a == b ? diagonal[a] : positions.places(group, a, b, vertex, diagonal));
  };
  add(b00, 0, 0), add(b01, 0, 1), add(b02, 0, 2), add(e.b11, 1, 1), add(e.b12, 1, 2), add(e.b22, 2, 2);
}

}  // namespace ft::inline solvers::membrane

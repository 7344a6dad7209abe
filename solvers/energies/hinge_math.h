// Dihedral angles and their gradients, k_lanes hinges at once: x0, x1 is the edge, x2 and x3 are the outer vertices, e
// = x1 - x0, a = x2 - x0, b = x3 - x0. Own arctangent: it vectorises, and its bits do not depend on the mathematics
// library.
#pragma once

#include <cmath>

#include "solvers/energies/element_schedule.h"

namespace ft::inline solvers {

using HingeLane = double[k_lanes];

/// atan(t) for t >= 0: two half-angle steps bring tan down to below tan(pi / 16) for t <= 1, then the series; error
/// below 1e-14.
inline double arctangent(double t) {
  const double u = t / (1 + std::sqrt(1 + t * t));
  const double w = u / (1 + std::sqrt(1 + u * u));
  const double z = w * w;
  double p = -1.0 / 19;
  p = 1.0 / 17 + z * p, p = -1.0 / 15 + z * p, p = 1.0 / 13 + z * p, p = -1.0 / 11 + z * p, p = 1.0 / 9 + z * p;
  p = -1.0 / 7 + z * p, p = 1.0 / 5 + z * p, p = -1.0 / 3 + z * p, p = 1.0 + z * p;
  return 4 * w * p;
}

/// Angle between the area normals n = e x a and m = b x e, about e [rad], in (-pi, pi]; 0 when degenerate.
inline void hinge_angle_lanes(const HingeLane* e, const HingeLane* a, const HingeLane* b, HingeLane& out) {
  for (int l = 0; l < k_lanes; ++l) {
    const double e0 = e[0][l], e1 = e[1][l], e2 = e[2][l];
    const double a0 = a[0][l], a1 = a[1][l], a2 = a[2][l], b0 = b[0][l], b1 = b[1][l], b2 = b[2][l];
    const double n0 = e1 * a2 - e2 * a1, n1 = e2 * a0 - e0 * a2, n2 = e0 * a1 - e1 * a0;
    const double m0 = b1 * e2 - b2 * e1, m1 = b2 * e0 - b0 * e2, m2 = b0 * e1 - b1 * e0;
    const double nn = n0 * n0 + n1 * n1 + n2 * n2, mm = m0 * m0 + m1 * m1 + m2 * m2;
    const double length = std::sqrt(e0 * e0 + e1 * e1 + e2 * e2);
    const double k0 = n1 * m2 - n2 * m1, k1 = n2 * m0 - n0 * m2, k2 = n0 * m1 - n1 * m0;
    const double sine = (k0 * e0 + k1 * e1 + k2 * e2) / (length > 1e-150 ? length : 1e-150);
    const double cosine = std::sqrt(nn * mm) + (n0 * m0 + n1 * m1 + n2 * m2);  // tan(angle / 2) = sine / cosine
    const double y = sine < 0 ? -sine : sine, x = cosine > 0 ? cosine : 0;
    const double small = y < x ? y : x, large = y < x ? x : y;
    const double part = arctangent(small / (large > 1e-300 ? large : 1e-300));
    const double half = y < x ? part : 1.5707963267948966 - part;
    const double angle = large > 1e-300 ? 2 * half : 0;
    out[l] = sine < 0 ? -angle : angle;
  }
}

/// d angle / d x2 = g2, / d x3 = g3, / d x0 = -(1 - s2) g2 - (1 - s3) g3, / d x1 = -s2 g2 - s3 g3.
struct HingeGradients {
  alignas(32) HingeLane g2[3], g3[3];  ///< 1/m
  alignas(32) HingeLane s2, s3;        ///< where x2, x3 project on the edge, 0 at x0, 1 at x1
};

/// floor2, floor3: squared area normals below which the two triangles count as degenerate; their gradients are then
/// held down instead of growing without bound [m4].
inline void hinge_gradient_lanes(const HingeLane* e, const HingeLane* a, const HingeLane* b,
                                 const float (&floor2)[k_lanes], const float (&floor3)[k_lanes], HingeGradients& out) {
  for (int l = 0; l < k_lanes; ++l) {
    const double e0 = e[0][l], e1 = e[1][l], e2 = e[2][l];
    const double a0 = a[0][l], a1 = a[1][l], a2 = a[2][l], b0 = b[0][l], b1 = b[1][l], b2 = b[2][l];
    const double n0 = e1 * a2 - e2 * a1, n1 = e2 * a0 - e0 * a2, n2 = e0 * a1 - e1 * a0;
    const double m0 = b1 * e2 - b2 * e1, m1 = b2 * e0 - b0 * e2, m2 = b0 * e1 - b1 * e0;
    const double nn = n0 * n0 + n1 * n1 + n2 * n2, mm = m0 * m0 + m1 * m1 + m2 * m2;
    const double ee = e0 * e0 + e1 * e1 + e2 * e2;
    const double length = std::sqrt(ee), inverse = 1 / (ee > 1e-300 ? ee : 1e-300);
    const double wn = -length / (nn > floor2[l] ? nn : floor2[l]), wm = -length / (mm > floor3[l] ? mm : floor3[l]);
    out.g2[0][l] = wn * n0, out.g2[1][l] = wn * n1, out.g2[2][l] = wn * n2;
    out.g3[0][l] = wm * m0, out.g3[1][l] = wm * m1, out.g3[2][l] = wm * m2;
    out.s2[l] = (a0 * e0 + a1 * e1 + a2 * e2) * inverse;
    out.s3[l] = (b0 * e0 + b1 * e1 + b2 * e2) * inverse;
  }
}

}  // namespace ft::inline solvers

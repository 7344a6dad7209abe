// Dihedral angles of k_lanes hinges at once, with the gradients at the two outer vertices. Own arctangent: it vectorises, and its
// bits do not depend on the mathematics library.
#pragma once

#include <cmath>

#include "solvers/energies/element_schedule.h"

namespace ft {

using HingeLane = double[k_lanes];

/// atan(t) for t >= 0 in lanes: two half-angle steps bring t below tan(pi / 16), then the series; error below 1e-15.
inline double arctangent(double t) {
  const double u = t / (1 + std::sqrt(1 + t * t));
  const double w = u / (1 + std::sqrt(1 + u * u));
  const double z = w * w;
  double p = -1.0 / 19;
  p = 1.0 / 17 + z * p, p = -1.0 / 15 + z * p, p = 1.0 / 13 + z * p, p = -1.0 / 11 + z * p, p = 1.0 / 9 + z * p;
  p = -1.0 / 7 + z * p, p = 1.0 / 5 + z * p, p = -1.0 / 3 + z * p, p = 1.0 + z * p;
  return 4 * w * p;
}

/// What a hinge x0, x1 (edge), x2, x3 (outer) has: theta [rad] in (-pi, pi], and if asked for its gradients.
struct HingeAngles {
  alignas(32) HingeLane theta;
  alignas(32) HingeLane g2[3], g3[3];  ///< d theta / d x2, d x3 [1/m]
  alignas(32) HingeLane s2, s3;        ///< where x2, x3 project on the edge: x0 has -(1 - s2) g2 - (1 - s3) g3, x1 -s2 g2 - s3 g3
};

/// floor2: squared area normal below which a triangle counts as degenerate; its gradient is then held down instead of growing.
inline void hinge_angles(const HingeLane* e, const HingeLane* a, const HingeLane* b, const HingeLane& floor2, HingeAngles& out) {
  for (int l = 0; l < k_lanes; ++l) {
    const double e0 = e[0][l], e1 = e[1][l], e2 = e[2][l];
    const double a0 = a[0][l], a1 = a[1][l], a2 = a[2][l], b0 = b[0][l], b1 = b[1][l], b2 = b[2][l];
    // Area normals n = e x a, m = b x e.
    const double n0 = e1 * a2 - e2 * a1, n1 = e2 * a0 - e0 * a2, n2 = e0 * a1 - e1 * a0;
    const double m0 = b1 * e2 - b2 * e1, m1 = b2 * e0 - b0 * e2, m2 = b0 * e1 - b1 * e0;
    const double nn = n0 * n0 + n1 * n1 + n2 * n2, mm = m0 * m0 + m1 * m1 + m2 * m2;
    const double ee = e0 * e0 + e1 * e1 + e2 * e2;
    const double length = std::sqrt(ee);
    const double safe_length = length > 1e-150 ? length : 1e-150;
    const double k0 = n1 * m2 - n2 * m1, k1 = n2 * m0 - n0 * m2, k2 = n0 * m1 - n1 * m0;
    const double sine = (k0 * e0 + k1 * e1 + k2 * e2) / safe_length;
    const double cosine = std::sqrt(nn * mm) + (n0 * m0 + n1 * m1 + n2 * m2);  // tan(theta / 2) = sine / cosine
    const double y = sine < 0 ? -sine : sine, x = cosine > 0 ? cosine : 0;
    const double small = y < x ? y : x, large = y < x ? x : y;
    const double angle = arctangent(small / (large > 1e-300 ? large : 1e-300));
    const double half = y < x ? angle : 1.5707963267948966 - angle;
    const double theta = large > 1e-300 ? 2 * half : 0;
    out.theta[l] = sine < 0 ? -theta : theta;
    const double wn = -length / (nn > floor2[l] ? nn : floor2[l]), wm = -length / (mm > floor2[l] ? mm : floor2[l]);
    out.g2[0][l] = wn * n0, out.g2[1][l] = wn * n1, out.g2[2][l] = wn * n2;
    out.g3[0][l] = wm * m0, out.g3[1][l] = wm * m1, out.g3[2][l] = wm * m2;
    const double inverse = 1 / (ee > 1e-300 ? ee : 1e-300);
    out.s2[l] = (a0 * e0 + a1 * e1 + a2 * e2) * inverse;
    out.s3[l] = (b0 * e0 + b1 * e1 + b2 * e2) * inverse;
  }
}

}  // namespace ft

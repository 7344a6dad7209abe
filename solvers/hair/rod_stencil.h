// Strains of a discrete elastic rod at a vertex between two edges, with first and second derivatives (Bergou et al.
// 2008, 2010), for rods whose material frames are one unit director an edge: no angles, no reference frames.
//
//   kb = 2 te x tf / (1 + te . tf),  k1 = kb . (m2e + m2f)/2,  k2 = -kb . (m1e + m1f)/2,  m2 = t x m1
//   tw = 2 tan(tau/2) = 2 s / (1 + c),  c = P m1e . m1f,  s = (tf x P m1e) . m1f,  P parallel transport from te to tf
//
// Derivatives are by the edges e and f and by the turns theta_e, theta_f of their directors about them, where a
// director goes along with its edge by parallel transport. Order of unknowns: e, theta_e, f, theta_f.
#pragma once

#include "solvers/hair/lanes.h"

namespace ft::inline solvers {

/// From the unit vector `from` to the unit vector `to`.
template <class T>
V3<T> transported(const V3<T>& v, const V3<T>& from, const V3<T>& to) {
  return v - (dot(v, to) / (T{} + 1.0 + dot(from, to))) * (from + to);
}

template <class T>
struct RodStencil {
  V3<T> te, tf, m1e, m1f, m2e, m2f;  ///< unit
  T over_e, over_f;                  ///< 1 / length [1/m]
  V3<T> kb, tilde;
  T over_chi;
  T k1, k2, tw;  ///< curvatures and twist, integrated over the vertex [1]
};

/// te, tf: unit; over_e, over_f: inverse lengths of the edges.
template <class T>
RodStencil<T> stencil_of(const V3<T>& te, const V3<T>& tf, const V3<T>& m1e, const V3<T>& m1f, const T& over_e,
                         const T& over_f) {
  RodStencil<T> s;
  s.te = te, s.tf = tf, s.m1e = m1e, s.m1f = m1f;
  s.m2e = cross(te, m1e), s.m2f = cross(tf, m1f);
  s.over_e = over_e, s.over_f = over_f;
  const T one = all_lanes<T>(1), half = all_lanes<T>(0.5);
  s.over_chi = one / larger(T(one + dot(te, tf)), all_lanes<T>(1e-6));
  s.kb = T(2.0 * s.over_chi) * cross(te, tf);
  s.tilde = s.over_chi * (te + tf);
  s.k1 = half * dot(s.kb, s.m2e + s.m2f);
  s.k2 = -half * dot(s.kb, s.m1e + s.m1f);
  const V3<T> carried = m1e - T(dot(m1e, tf) * s.over_chi) * (te + tf);
  s.tw = 2.0 * dot(cross(tf, carried), m1f) / larger(T(one + dot(carried, m1f)), all_lanes<T>(1e-6));
  return s;
}

/// First derivatives of a strain.
template <class T>
struct RodSlope {
  V3<T> e, f;
  T theta_e, theta_f;
};
template <class T>
RodSlope<T> slope_k1(const RodStencil<T>& s) {
  const V3<T> d2 = s.over_chi * (s.m2e + s.m2f);
  return {s.over_e * (cross(s.tf, d2) - s.k1 * s.tilde), -s.over_f * (cross(s.te, d2) + s.k1 * s.tilde),
          -0.5 * dot(s.kb, s.m1e), -0.5 * dot(s.kb, s.m1f)};
}
template <class T>
RodSlope<T> slope_k2(const RodStencil<T>& s) {
  const V3<T> d1 = s.over_chi * (s.m1e + s.m1f);
  return {-s.over_e * (cross(s.tf, d1) + s.k2 * s.tilde), s.over_f * (cross(s.te, d1) - s.k2 * s.tilde),
          -0.5 * dot(s.kb, s.m2e), -0.5 * dot(s.kb, s.m2f)};
}
/// Of tau; that of tw is 1 + tw^2 / 4 times as much.
template <class T>
RodSlope<T> slope_tau(const RodStencil<T>& s) {
  return {T(0.5 * s.over_e) * s.kb, T(0.5 * s.over_f) * s.kb, all_lanes<T>(-1), all_lanes<T>(1)};
}

/// Second derivatives of a sum of strains: 8 x 8, symmetric.
template <class T>
struct RodCurve {
  M3<T> ee, ff, ef;  ///< ef: rows e, columns f
  V3<T> e_te, e_tf, f_te, f_tf;
  T tete, tftf;  ///< by theta_e twice, theta_f twice; mixed ones are 0
};
/// Of f1 k1 + f2 k2 + ft tau, for factors that do not change.
template <class T>
RodCurve<T> curve_of(const RodStencil<T>& s, const T& f1, const T& f2, const T& ft) {
  const T half = all_lanes<T>(0.5), quarter = all_lanes<T>(0.25);
  const V3<T> me = f1 * s.m2e - f2 * s.m1e, mf = f1 * s.m2f - f2 * s.m1f;
  const V3<T> d = s.over_chi * (me + mf);
  const T k = f1 * s.k1 + f2 * s.k2;
  const V3<T> fd = cross(s.tf, d), ed = cross(s.te, d);
  const M3<T> tilde2 = T(2.0 * k) * outer(s.tilde, s.tilde);
  const M3<T> fd_tilde = outer(fd, s.tilde), tilde_ed = outer(s.tilde, ed);
  const T straight = k * s.over_chi, one = all_lanes<T>(1);
  const T ee = s.over_e * s.over_e, ff = s.over_f * s.over_f, ef = s.over_e * s.over_f;
  RodCurve<T> out;
  const M3<T> kb_me = outer(s.kb, me), kb_mf = outer(s.kb, mf);
  out.ee = ee * (tilde2 - fd_tilde - transposed(fd_tilde) - straight * (diagonal(one) - outer(s.te, s.te)) +
                 quarter * (kb_me + transposed(kb_me)));
  out.ff = ff * (tilde2 + tilde_ed + transposed(tilde_ed) - straight * (diagonal(one) - outer(s.tf, s.tf)) +
                 quarter * (kb_mf + transposed(kb_mf)));
  out.ef = ef * (tilde2 - fd_tilde + tilde_ed - straight * (diagonal(one) + outer(s.te, s.tf)) - cross_matrix(d));
  // By the turns: m2 turns into -m1, m1 into m2.
  const V3<T> ne = f1 * s.m1e + f2 * s.m2e, nf = f1 * s.m1f + f2 * s.m2f;
  out.e_te = s.over_e * (T(half * dot(s.kb, ne)) * s.tilde - s.over_chi * cross(s.tf, ne));
  out.e_tf = s.over_e * (T(half * dot(s.kb, nf)) * s.tilde - s.over_chi * cross(s.tf, nf));
  out.f_te = s.over_f * (T(half * dot(s.kb, ne)) * s.tilde + s.over_chi * cross(s.te, ne));
  out.f_tf = s.over_f * (T(half * dot(s.kb, nf)) * s.tilde + s.over_chi * cross(s.te, nf));
  out.tete = -half * dot(s.kb, me);
  out.tftf = -half * dot(s.kb, mf);
  // Twist.
  const V3<T> sum_e = s.te + s.tilde, sum_f = s.tf + s.tilde;
  const M3<T> kb_e = outer(s.kb, sum_e), kb_f = outer(s.kb, sum_f);
  out.ee -= T(quarter * ft * ee) * (kb_e + transposed(kb_e));
  out.ff -= T(quarter * ft * ff) * (kb_f + transposed(kb_f));
  out.ef += T(half * ft * ef) * (T(2.0 * s.over_chi) * cross_matrix(s.te) - outer(s.kb, s.tilde));
  return out;
}

}  // namespace ft::inline solvers

#include "solvers/hair/rod.h"

namespace ft::inline solvers {
namespace {

template <class T>
V3<T> unit(const V3<T>& a, T& length, T& over) {
  length = larger(norm(a), all_lanes<T>(1e-12));
  over = all_lanes<T>(1) / length;
  return over * a;
}

template <class T>
struct Edges {
  std::vector<V3<T>> t;
  std::vector<T> length, over;
  explicit Edges(const RodPose<T>& pose) {
    const std::size_t count = pose.x.size() - 1;
    t.resize(count), length.resize(count), over.resize(count);
    for (std::size_t j = 0; j < count; ++j) t[j] = unit(pose.x[j + 1] - pose.x[j], length[j], over[j]);
  }
};

template <class T>
RodStencil<T> stencil_at(const RodPose<T>& pose, const Edges<T>& edges, std::size_t i) {
  return stencil_of(edges.t[i - 1], edges.t[i], pose.director[i - 1], pose.director[i], edges.over[i - 1],
                    edges.over[i]);
}

template <class T>
void add(V3<T>& a, const T& s, const V3<T>& b) {
  a.x += s * b.x, a.y += s * b.y, a.z += s * b.z;
}

/// A sum of slopes.
template <class T>
RodSlope<T> together(const T& f1, const RodSlope<T>& a, const T& f2, const RodSlope<T>& b, const T& ft,
                     const RodSlope<T>& c) {
  RodSlope<T> out;
  add(out.e, f1, a.e), add(out.e, f2, b.e), add(out.e, ft, c.e);
  add(out.f, f1, a.f), add(out.f, f2, b.f), add(out.f, ft, c.f);
  out.theta_e = f1 * a.theta_e + f2 * b.theta_e + ft * c.theta_e;
  out.theta_f = f1 * a.theta_f + f2 * b.theta_f + ft * c.theta_f;
  return out;
}

template <class T>
void add_block(BandedMatrix<T>& h, int row, int column, const M3<T>& m) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (row + a >= column + b) h(row + a, column + b) += m(a, b);
}
template <class T>
void add_rank_one(M3<T>& m, const T& s, const V3<T>& a, const V3<T>& b) {
  add(m.r[0], T(s * a.x), b), add(m.r[1], T(s * a.y), b), add(m.r[2], T(s * a.z), b);
}
/// A row of three, below or left of the diagonal as it falls.
template <class T>
void add_row(BandedMatrix<T>& h, int turn, int place, const V3<T>& v) {
  const T values[3] = {v.x, v.y, v.z};
  for (int a = 0; a < 3; ++a) {
    if (turn > place + a)
      h(turn, place + a) += values[a];
    else
      h(place + a, turn) += values[a];
  }
}

/// 8 x 8 by edges -> 11 x 11 by vertices i - 1, i, i + 1 and the turns of the edges at i - 1 and i.
template <class T>
void scatter(BandedMatrix<T>& h, std::size_t i, const RodCurve<T>& c, const T& turns) {
  const int p = 4 * (static_cast<int>(i) - 1), q = p + 4, r = p + 8, te = p + 3, tf = q + 3;
  const M3<T> fe = transposed(c.ef);
  add_block(h, p, p, c.ee);
  add_block(h, q, p, fe - c.ee);
  add_block(h, q, q, c.ee - c.ef - fe + c.ff);
  add_block(h, r, p, M3<T>{} - fe);
  add_block(h, r, q, fe - c.ff);
  add_block(h, r, r, c.ff);
  add_row(h, te, p, -c.e_te), add_row(h, te, q, c.e_te - c.f_te), add_row(h, te, r, c.f_te);
  add_row(h, tf, p, -c.e_tf), add_row(h, tf, q, c.e_tf - c.f_tf), add_row(h, tf, r, c.f_tf);
  h(te, te) += c.tete;
  h(tf, tf) += c.tftf;
  h(tf, te) += turns;
}

}  // namespace

template <class T>
void strains_of(const RodPose<T>& pose, RodStrains<T>& out) {
  const Edges<T> edges(pose);
  const std::size_t n = pose.x.size();
  out.stretched = edges.length;
  out.k1.assign(n, T{}), out.k2.assign(n, T{}), out.tw.assign(n, T{});
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const RodStencil<T> s = stencil_at(pose, edges, i);
    out.k1[i] = s.k1, out.k2[i] = s.k2, out.tw[i] = s.tw;
  }
}

template <class T>
T potential(const Rod<T>& rod, const RodPose<T>& pose, const std::type_identity_t<RodStrains<T>>* since,
            double damping) {
  const Edges<T> edges(pose);
  const std::size_t n = at(rod.n);
  T sum{};
  for (std::size_t j = 1; j + 1 < n; ++j) {
    const T off = edges.length[j] - rod.length[j], k = rod.stretch / rod.length[j];
    sum += 0.5 * k * off * off;
    if (since) {
      const T rate = edges.length[j] - since->stretched[j];
      sum += (0.5 * damping) * k * rate * rate;
    }
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const RodStencil<T> s = stencil_at(pose, edges, i);
    const T over = all_lanes<T>(0.5) / rod.voronoi[i];
    const T a = s.k1 - rod.k1[i], b = s.k2 - rod.k2[i], c = s.tw - rod.tw[i];
    sum += over * (rod.bend * (a * a + b * b) + rod.twist * c * c);
    if (since) {
      const T da = s.k1 - since->k1[i], db = s.k2 - since->k2[i], dc = s.tw - since->tw[i];
      sum += damping * over * (rod.bend * (da * da + db * db) + rod.twist * dc * dc);
    }
  }
  return sum;
}

template <class T>
T add_potential(const Rod<T>& rod, const RodPose<T>& pose, const std::type_identity_t<RodStrains<T>>* since,
                double damping, const RodHessian<T>& wanted, std::vector<T>& gradient,
                std::type_identity_t<BandedMatrix<T>>* hessian) {
  const Edges<T> edges(pose);
  const std::size_t n = at(rod.n);
  T sum{};
  const double stiffer = since ? 1 + damping : 1;
  const auto add_gradient = [&](std::size_t vertex, const V3<T>& g) {
    gradient[4 * vertex] += g.x, gradient[4 * vertex + 1] += g.y, gradient[4 * vertex + 2] += g.z;
  };
  for (std::size_t j = 1; j + 1 < n; ++j) {
    const T k = rod.stretch / rod.length[j], off = edges.length[j] - rod.length[j];
    T force = k * off;
    sum += 0.5 * k * off * off;
    if (since) {
      const T rate = edges.length[j] - since->stretched[j];
      force += damping * k * rate;
      sum += (0.5 * damping) * k * rate * rate;
    }
    const V3<T> g = force * edges.t[j];
    add_gradient(j + 1, g);
    add_gradient(j, -g);
    if (!hessian) continue;
    const T tension = wanted.tension ? (*wanted.tension)[j] : force;
    const T across = edges.over[j] * choose(wanted.full > 0.5, tension, larger(tension, T{}));
    M3<T> block = diagonal(across);
    add_rank_one(block, T(stiffer * k - across), edges.t[j], edges.t[j]);
    const int a = 4 * static_cast<int>(j), b = a + 4;
    add_block(*hessian, a, a, block);
    add_block(*hessian, b, b, block);
    add_block(*hessian, b, a, M3<T>{} - block);
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const RodStencil<T> s = stencil_at(pose, edges, i);
    const T over = all_lanes<T>(1) / rod.voronoi[i], bend = rod.bend * over, twist = rod.twist * over;
    const T a = s.k1 - rod.k1[i], b = s.k2 - rod.k2[i], c = s.tw - rod.tw[i];
    sum += 0.5 * (bend * (a * a + b * b) + twist * c * c);
    T f1 = bend * a, f2 = bend * b, ft = twist * c;
    if (since) {
      const T da = s.k1 - since->k1[i], db = s.k2 - since->k2[i], dc = s.tw - since->tw[i];
      f1 += damping * bend * da, f2 += damping * bend * db, ft += damping * twist * dc;
      sum += (0.5 * damping) * (bend * (da * da + db * db) + twist * dc * dc);
    }
    const T by_tau = 1.0 + 0.25 * s.tw * s.tw;  // of tw
    const RodSlope<T> s1 = slope_k1(s), s2 = slope_k2(s), st = slope_tau(s);
    const RodSlope<T> g = together(f1, s1, f2, s2, T(ft * by_tau), st);
    add_gradient(i - 1, -g.e);
    add_gradient(i, g.e - g.f);
    add_gradient(i + 1, g.f);
    gradient[4 * i - 1] += g.theta_e;
    gradient[4 * i + 3] += g.theta_f;
    if (!hessian) continue;
    const T full = wanted.full;
    RodCurve<T> h = curve_of(s, T(full * f1), T(full * f2), T(full * ft * by_tau));
    // Gauss and Newton's part, and the second derivative of tw by tau.
    const T k1 = stiffer * bend, kt = stiffer * twist * by_tau * by_tau + full * ft * 0.5 * s.tw * by_tau;
    T turns{};
    const auto add_square = [&](const T& k, const RodSlope<T>& d) {
      add_rank_one(h.ee, k, d.e, d.e), add_rank_one(h.ff, k, d.f, d.f), add_rank_one(h.ef, k, d.e, d.f);
      add(h.e_te, T(k * d.theta_e), d.e), add(h.e_tf, T(k * d.theta_f), d.e);
      add(h.f_te, T(k * d.theta_e), d.f), add(h.f_tf, T(k * d.theta_f), d.f);
      h.tete += k * d.theta_e * d.theta_e, h.tftf += k * d.theta_f * d.theta_f;
      turns += k * d.theta_e * d.theta_f;
    };
    add_square(k1, s1), add_square(k1, s2), add_square(kt, st);
    scatter(*hessian, i, h, turns);
  }
  return sum;
}

template <class T>
V3<T> carried_director(const V3<T>& director, const V3<T>& before, const V3<T>& now) {
  V3<T> out = transported(director, before, now);
  out -= dot(out, now) * now;
  T length, over;
  return unit(out, length, over);
}

template <class T>
void move_pose(const std::vector<T>& step, const T& share, const RodPose<T>& from, RodPose<T>& to) {
  const std::size_t n = from.x.size();
  to.x.resize(n), to.director.resize(n - 1);
  for (std::size_t i = 0; i < n; ++i) {
    to.x[i] = from.x[i];
    add(to.x[i], share, V3<T>{step[4 * i], step[4 * i + 1], step[4 * i + 2]});
  }
  for (std::size_t j = 0; j + 1 < n; ++j) {
    T length, over;
    const V3<T> before = unit(from.x[j + 1] - from.x[j], length, over), now = unit(to.x[j + 1] - to.x[j], length, over);
    const V3<T> m = carried_director(from.director[j], before, now);
    // Cayley: no sine, and unit exactly.
    const T half = 0.5 * share * step[4 * j + 3], bottom = all_lanes<T>(1) / (1.0 + half * half);
    to.director[j] = T((1.0 - half * half) * bottom) * m + T(2.0 * half * bottom) * cross(now, m);
  }
}

template void strains_of(const RodPose<double>&, RodStrains<double>&);
template void strains_of(const RodPose<Lanes>&, RodStrains<Lanes>&);
template double potential(const Rod<double>&, const RodPose<double>&, const RodStrains<double>*, double);
template Lanes potential(const Rod<Lanes>&, const RodPose<Lanes>&, const RodStrains<Lanes>*, double);
template double add_potential(const Rod<double>&, const RodPose<double>&, const RodStrains<double>*, double,
                              const RodHessian<double>&, std::vector<double>&, BandedMatrix<double>*);
template Lanes add_potential(const Rod<Lanes>&, const RodPose<Lanes>&, const RodStrains<Lanes>*, double,
                             const RodHessian<Lanes>&, std::vector<Lanes>&, BandedMatrix<Lanes>*);
template void move_pose(const std::vector<double>&, const double&, const RodPose<double>&, RodPose<double>&);
template void move_pose(const std::vector<Lanes>&, const Lanes&, const RodPose<Lanes>&, RodPose<Lanes>&);
template V3<double> carried_director(const V3<double>&, const V3<double>&, const V3<double>&);
template V3<Lanes> carried_director(const V3<Lanes>&, const V3<Lanes>&, const V3<Lanes>&);

}  // namespace ft::inline solvers

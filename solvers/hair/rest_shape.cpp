#include "solvers/hair/rest_shape.h"

#include <Eigen/LU>
#include <cmath>

namespace ft::inline solvers {
namespace {

struct Moments {
  double b1 = 0, b2 = 0, s = 0;  ///< of curvatures and of tau [N m]
};

struct Slopes {
  RodSlope<double> k1, k2, tau;
  Vec3 e(const Moments& m) const { return plain(m.b1 * k1.e + m.b2 * k2.e + m.s * tau.e); }
  Vec3 f(const Moments& m) const { return plain(m.b1 * k1.f + m.b2 * k2.f + m.s * tau.f); }
  double turn_e(const Moments& m) const { return m.b1 * k1.theta_e + m.b2 * k2.theta_e - m.s; }
};

}  // namespace

void make_rest_shape(Rod<double>& rod, const RodPose<double>& pose, std::span<const Vec3> forces) {
  const std::size_t n = at(rod.n);
  std::vector<Vec3> t(n - 1);
  std::vector<double> length(n - 1), tension(n, 0.0);
  for (std::size_t j = 0; j + 1 < n; ++j) {
    const Vec3 e = plain(pose.x[j + 1] - pose.x[j]);
    length[j] = e.norm();
    t[j] = e / length[j];
  }
  std::vector<Slopes> slopes(n);
  std::vector<Moments> moments(n + 1);
  RodStrains<double> now;
  strains_of(pose, now);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const RodStencil<double> s = stencil_of(plain(t[i - 1]), plain(t[i]), pose.director[i - 1], pose.director[i],
                                            1 / length[i - 1], 1 / length[i]);
    slopes[i] = {slope_k1(s), slope_k2(s), slope_tau(s)};
  }
  // Forces on vertex k: of the edge before it, of the stencils in which it is last, middle and first.
  for (std::size_t k = n - 1; k >= 2; --k) {
    const std::size_t i = k - 1;
    Vec3 carries = forces[k];
    double turn = 0;
    if (k + 1 < n) {
      carries += tension[k] * t[k] - (slopes[k].e(moments[k]) - slopes[k].f(moments[k]));
      turn -= slopes[k].turn_e(moments[k]);
    }
    if (k + 2 < n) carries += slopes[k + 1].e(moments[k + 1]);
    Eigen::Matrix4d system;
    Eigen::Vector4d wanted;
    const Vec3 columns[4] = {t[i], plain(slopes[i].k1.f), plain(slopes[i].k2.f), plain(slopes[i].tau.f)};
    for (int c = 0; c < 4; ++c)
      for (int a = 0; a < 3; ++a) system(a, c) = columns[c][a];
    for (int a = 0; a < 3; ++a) wanted[a] = carries[a];
    system(3, 0) = 0, system(3, 1) = slopes[i].k1.theta_f, system(3, 2) = slopes[i].k2.theta_f, system(3, 3) = 1;
    wanted[3] = turn;
    const Eigen::Vector4d found = system.fullPivLu().solve(wanted);
    tension[i] = found[0];
    moments[i] = {found[1], found[2], found[3]};
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double v = rod.voronoi[i];
    rod.k1[i] = now.k1[i] - moments[i].b1 * v / rod.bend;
    rod.k2[i] = now.k2[i] - moments[i].b2 * v / rod.bend;
    rod.tw[i] = now.tw[i] - moments[i].s * v / (rod.twist * (1 + 0.25 * now.tw[i] * now.tw[i]));
    rod.length[i] = length[i] / (1 + tension[i] / rod.stretch);
  }
}

double slowest_wanted(double length, double gravity) {
  return 0.7 * 1.2024 * std::sqrt(gravity / length);
}

bool is_stable(const Rod<double>& rod, const RodPose<double>& pose, double slowest, int held) {
  std::vector<double> gradient(at(rod.unknowns()));
  BandedMatrix<double> hessian;
  hessian.reset(rod.unknowns());
  add_potential(rod, pose, nullptr, 0, RodHessian<double>(), gradient, &hessian);
  for (int i = 2; i < rod.n; ++i)
    for (int a = 0; a < 3; ++a) hessian(4 * i + a, 4 * i + a) -= slowest * slowest * rod.mass[at(i)];
  // All that is given: of the last held vertex its position, and the turns of edges before it.
  const int first = 4 * std::clamp(held, 1, rod.n - 1) + 3;
  return first >= rod.unknowns() || hessian.factor(first) > 0;
}

void stand_still_at(double factor, Rod<double>& rod, const RodPose<double>& pose, std::span<const Vec3> forces) {
  rod.bend *= factor;
  rod.twist *= factor;
  make_rest_shape(rod, pose, forces);
}

double stand_still(Rod<double>& rod, const RodPose<double>& pose, std::span<const Vec3> forces, double slowest,
                   int held) {
  const auto stands = [&](double factor) {
    Rod<double> trial = rod;
    stand_still_at(factor, trial, pose, forces);
    return is_stable(trial, pose, slowest, held);
  };
  double factor = 1, low = 1;
  while (!stands(factor) && factor < 4096) low = factor, factor *= 2;
  if (factor > 1)
    for (int k = 0; k < 5; ++k) {  // to 3 %
      const double middle = std::sqrt(low * factor);
      (stands(middle) ? factor : low) = middle;
    }
  stand_still_at(factor, rod, pose, forces);
  return factor;
}

}  // namespace ft::inline solvers

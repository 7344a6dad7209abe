#include "solvers/cloth/carry_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "collision/pair_geometry.h"

namespace ft {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Pull {
  std::array<int, 4> vertex;
  std::array<double, 4> weight;
  Vec3 normal;
  double strength;
  double target;  ///< n . u_body at the contact
};

}  // namespace

void carry_field(const CarryInput& in, std::span<Vec3> carry) {
  const int n = in.cloth_vertex_count;
  const double g = 1.0 / (in.range * in.range);
  std::vector<Pull> pulls;
  double fastest = 0;
  for (const Stencil& s : in.pairs->vertex_face) {
    const bool first_cloth = s.v[0] < n;
    if (first_cloth == (s.v[3] < n)) continue;
    const PairGeometry geo = vertex_face_geometry(in.x[at(s.v[0])], in.x[at(s.v[1])], in.x[at(s.v[2])], in.x[at(s.v[3])]);
    if (geo.distance >= in.range || geo.distance <= 0) continue;
    Vec3 body = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (s.v[k] >= n) body += geo.weight[k] * in.body_motion[at(s.v[k] - n)];
    fastest = std::max(fastest, body.norm());
    // sum weight * displacement over all four vertices is the relative motion: the cloth's part shall cancel the body's.
    const double d = std::max(geo.distance, 1e-5);
    pulls.push_back({s.v, geo.weight, geo.normal, 1.0 / (d * d) - g, -geo.normal.dot(body)});
  }
  double fastest_own = 0;
  for (int i = 0; i < n; ++i) fastest_own = std::max(fastest_own, in.inertia[at(i)].norm());

  std::vector<Mat3> block(at(n), Mat3::Identity() * g);
  for (const Edge& e : in.edges) {
    block[at(e[0])] += Mat3::Identity() * (8 * g);
    block[at(e[1])] += Mat3::Identity() * (8 * g);
  }
  // l1-Jacobi: the diagonal carries the absolute row sum, so that shared contacts cannot make the sweeps diverge.
  for (const Pull& p : pulls) {
    double row = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (p.vertex[k] < n) row += std::abs(p.weight[k]);
    for (std::size_t k = 0; k < 4; ++k)
      if (p.vertex[k] < n)
        block[at(p.vertex[k])] += (p.strength * std::abs(p.weight[k]) * row) * p.normal * p.normal.transpose();
  }
  for (Mat3& b : block) b = b.inverse().eval();

  for (int i = 0; i < n; ++i) carry[at(i)] = in.inertia[at(i)];
  std::vector<Vec3> residual(at(n));
  for (int sweep = 0; sweep < in.sweeps; ++sweep) {
    for (int i = 0; i < n; ++i) residual[at(i)] = g * (in.inertia[at(i)] - carry[at(i)]);
    for (const Edge& e : in.edges) {
      const Vec3 d = (4 * g) * (carry[at(e[0])] - carry[at(e[1])]);
      residual[at(e[0])] -= d;
      residual[at(e[1])] += d;
    }
    for (const Pull& p : pulls) {
      double here = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (p.vertex[k] < n) here += p.weight[k] * p.normal.dot(carry[at(p.vertex[k])]);
      const double missing = p.strength * (p.target - here);
      for (std::size_t k = 0; k < 4; ++k)
        if (p.vertex[k] < n) residual[at(p.vertex[k])] += (missing * p.weight[k]) * p.normal;
    }
    for (int i = 0; i < n; ++i) carry[at(i)] += block[at(i)] * residual[at(i)];
  }
  const double cap = 1.2 * std::max(fastest, fastest_own);
  for (int i = 0; i < n; ++i) {
    const double length = carry[at(i)].norm();
    if (length > cap) carry[at(i)] *= cap / length;
  }
}

}  // namespace ft

#include "solvers/lockstep/cord_elements.h"

#include <algorithm>

namespace ft {

void CordElements::begin_step(std::span<const Vec3> x, double rate_time) {
  now_.clear();
  for (const CordSpring& s : springs) {
    double before = (x[at(s.a)] - x[at(s.b)]).norm() - s.length;
    if (!s.pushes) before = std::max(before, 0.0);
    const double damping = s.damping / rate_time, stiffness = s.stiffness + damping;
    now_.push_back({s.length + damping / stiffness * before, stiffness});
  }
}

double CordElements::value(std::span<const Vec3> x) const {
  double sum = 0;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const CordSpring& s = springs[i];
    const double stretch = (x[at(s.a)] - x[at(s.b)]).norm() - now_[i].length;
    if (stretch > 0 || s.pushes) sum += 0.5 * now_[i].stiffness * stretch * stretch;
  }
  for (const CordBend& b : bends)
    sum += 0.5 * b.stiffness * (x[at(b.node[0])] - 2 * x[at(b.node[1])] + x[at(b.node[2])]).squaredNorm();
  for (const CordHold& h : holds) sum += 0.5 * h.stiffness * (x[at(h.node)] - h.place).squaredNorm();
  return sum;
}

void CordElements::add_terms(std::span<const Vec3> x, std::vector<NodeTerm>& out) const {
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const CordSpring& s = springs[i];
    const Vec3 way = x[at(s.a)] - x[at(s.b)];
    const double length = way.norm(), stretch = length - now_[i].length;
    if ((stretch <= 0 && !s.pushes) || length <= 0) continue;
    const Vec3 along = way / length;
    NodeTerm& t = out.emplace_back();
    t.add(s.a, 1), t.add(s.b, -1);
    t.force = now_[i].stiffness * stretch * along;
    const double across = std::max(0.0, now_[i].stiffness * stretch / length);
    t.stiffness = across * Mat3::Identity() + (now_[i].stiffness - across) * along * along.transpose();
  }
  for (const CordBend& b : bends) {
    NodeTerm& t = out.emplace_back();
    t.add(b.node[0], 1), t.add(b.node[1], -2), t.add(b.node[2], 1);
    t.force = b.stiffness * (x[at(b.node[0])] - 2 * x[at(b.node[1])] + x[at(b.node[2])]);
    t.stiffness = b.stiffness * Mat3::Identity();
  }
  for (const CordHold& h : holds) {
    NodeTerm& t = out.emplace_back();
    t.add(h.node, 1);
    t.force = h.stiffness * (x[at(h.node)] - h.place);
    t.stiffness = h.stiffness * Mat3::Identity();
  }
}

Vec3 CordElements::hold_force(std::span<const Vec3> x) const {
  Vec3 sum = Vec3::Zero();
  for (const CordHold& h : holds) sum -= h.stiffness * (x[at(h.node)] - h.place);
  return sum;
}

}  // namespace ft

#include "solvers/lockstep/cord_elements.h"

#include <algorithm>

namespace ft::inline solvers {
namespace {

constexpr double k_drag_coefficient = 1.2;  ///< of a long cylinder across the flow, Re 1e2 to 1e5 (Hoerner 1965)

}  // namespace

void CordElements::begin_step(double end, double h, std::span<const Vec3> x, std::span<const Vec3> v) {
  now_.clear();
  bent_.clear();
  drag_.clear();
  h_ = h;
  for (const CordSpring& s : springs) {
    double before = (x[at(s.a)] - x[at(s.b)]).norm() - s.length;
    if (!s.pushes) before = std::max(before, 0.0);
    const double damping = s.damping / h, stiffness = s.stiffness + damping;
    now_.push_back({s.length + damping / stiffness * before, stiffness});
  }
  for (const CordBend& b : bends) bent_.push_back(bend_of(b, x));
  if (air.density <= 0) return;
  const std::unique_ptr<AirNow> wind = air.wind && !air.wind->is_still() ? air.wind->at_time(end) : nullptr;
  for (const CordDrag& d : drags) {
    const Vec3 way = x[at(d.a)] - x[at(d.b)];
    const double length2 = way.squaredNorm();
    Mat3 across = Mat3::Identity();
    if (length2 > 0) across -= way * way.transpose() / length2;
    const Vec3 middle = 0.5 * (x[at(d.a)] + x[at(d.b)]), blows = wind ? wind->velocity(middle) : Vec3::Zero();
    const double speed = (across * (0.5 * (v[at(d.a)] + v[at(d.b)]) - blows)).norm();
    const Vec3 goal = middle + h * blows;
    drag_.push_back({0.5 * air.density * k_drag_coefficient * d.area * speed / h * across, goal});
  }
}

double CordElements::value(std::span<const Vec3> x) const {
  double sum = 0;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const CordSpring& s = springs[i];
    const double stretch = (x[at(s.a)] - x[at(s.b)]).norm() - now_[i].length;
    if (stretch > 0 || s.pushes) sum += 0.5 * now_[i].stiffness * stretch * stretch;
  }
  for (std::size_t i = 0; i < bends.size(); ++i) {
    const Vec3 bent = bend_of(bends[i], x);
    sum +=
        0.5 * bends[i].stiffness * bent.squaredNorm() + 0.5 * bends[i].damping / h_ * (bent - bent_[i]).squaredNorm();
  }
  for (std::size_t i = 0; i < drag_.size(); ++i) {
    const Vec3 off = 0.5 * (x[at(drags[i].a)] + x[at(drags[i].b)]) - drag_[i].goal;
    sum += 0.5 * off.dot(drag_[i].stiffness * off);
  }
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
  for (std::size_t i = 0; i < bends.size(); ++i) {
    const CordBend& b = bends[i];
    const Vec3 bent = bend_of(b, x);
    NodeTerm& t = out.emplace_back();
    t.add(b.node[0], 1), t.add(b.node[1], -2), t.add(b.node[2], 1);
    t.force = b.stiffness * bent + b.damping / h_ * (bent - bent_[i]);
    t.stiffness = (b.stiffness + b.damping / h_) * Mat3::Identity();
  }
  for (std::size_t i = 0; i < drag_.size(); ++i) {
    NodeTerm& t = out.emplace_back();
    t.add(drags[i].a, 0.5), t.add(drags[i].b, 0.5);
    t.force = drag_[i].stiffness * (0.5 * (x[at(drags[i].a)] + x[at(drags[i].b)]) - drag_[i].goal);
    t.stiffness = drag_[i].stiffness;
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

}  // namespace ft::inline solvers

#include "solvers/energies/air_drag.h"

#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 512;

}  // namespace

AirDrag::AirDrag(const ClothTopology& topology, const AirSettings& air) : air_(air) {
  for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
    if (topology.rest_area[t] == 0) continue;
    const Fabric& fabric = topology.fabric_of_triangle(t);
    const double factor = 0.5 * air.density * topology.rest_area[t] / 3;
    triangles_.push_back(topology.triangles[t]);
    normal_factor_.push_back(static_cast<float>(factor * fabric.drag_normal));
    tangential_factor_.push_back(static_cast<float>(factor * fabric.drag_tangential));
    still_ = still_ && normal_factor_.back() == 0 && tangential_factor_.back() == 0;
  }
  triangles_.shrink_to_fit();
  normal_factor_.shrink_to_fit();
  tangential_factor_.shrink_to_fit();
  around_ = vertex_triangles(topology.vertex_count, triangles_);
}

AirDrag::Panel AirDrag::panel(std::size_t triangle, const StepContext& context) const {
  const Triangle& t = triangles_[triangle];
  Vec3 corner[3], velocity = -air_.wind;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& v = context.v_t0[at(t[k])];
    corner[k] = context.x_t0[at(t[k])] + context.h * v;
    velocity += v / 3;
  }
  Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double length = normal.norm();
  if (!(length > 1e-30)) return {};
  normal /= length;
  const Vec3 vn = normal * normal.dot(velocity), vt = velocity - vn;
  const double dn = normal_factor_[triangle] * vn.norm(), dt = tangential_factor_[triangle] * vt.norm();
  const Mat3 across = normal * normal.transpose();
  const Mat3 damping = 2 * dn * across + 2 * dt * (Mat3::Identity() - across);
  const Vec3 force = damping * air_.wind + dn * vn + dt * vt;  // -(D (v - w) - dn vn - dt vt) at v = 0
  const auto entry = [](double value) { return static_cast<float>(value); };
  return {{entry(damping(0, 0)), entry(damping(1, 1)), entry(damping(2, 2)), entry(damping(0, 1)), entry(damping(1, 2)),
           entry(damping(2, 0))},
          {entry(force[0]), entry(force[1]), entry(force[2])}};
}

AirDrag::Panel& AirDrag::Panel::operator+=(const Panel& other) {
  for (std::size_t k = 0; k < damping.size(); ++k) damping[k] += other.damping[k];
  for (std::size_t k = 0; k < force.size(); ++k) force[k] += other.force[k];
  return *this;
}

Mat3 AirDrag::Panel::damping_matrix() const {
  const auto& [xx, yy, zz, xy, yz, zx] = damping;
  return Mat3f{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}.cast<double>();
}

Vec3 AirDrag::Panel::force_vector() const {
  return {force[0], force[1], force[2]};
}

/// Of the rate formula.
Vec3 AirDrag::velocity(std::span<const Vec3> x, std::size_t i) const {
  const Vec3 reference = b_ != 0 ? (a_ * x_t0_[i] - b_ * x_tm1_[i]).eval() : x_t0_[i];
  return (x[i] - reference) / rate_time_;
}

void AirDrag::begin_step(const StepContext& context) {
  if (still_) return;
  CHECK(context.v_t0.size() == context.x_t0.size());
  rate_time_ = context.rate_time();
  panels_.resize(triangles_.size());
  parallel_for(triangles_.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) panels_[t] = panel(t, context);
  });
  const std::size_t n = context.x_t0.size();
  vertices_.resize(n);
  x_t0_ = context.x_t0;
  x_tm1_ = context.x_tm1;
  a_ = context.a;
  b_ = context.has_history() ? context.b : 0;
  parallel_for(n, k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Panel sum;
      if (i + 1 < around_.start.size())
        for (const int t : around_.row(static_cast<int>(i))) sum += panels_[at(t)];
      vertices_[i] = sum;
    }
  });
}

double AirDrag::value(std::span<const Vec3> x) const {
  if (still_ || vertices_.empty()) return 0;
  return parallel_sum(x.size(), k_block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 v = velocity(x, i);
      sum += rate_time_ * v.dot(0.5 * (vertices_[i].damping_matrix() * v) - vertices_[i].force_vector());
    }
    return sum;
  });
}

void AirDrag::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  if (still_ || vertices_.empty()) return;
  parallel_for(x.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      gradient[i] += vertices_[i].damping_matrix() * velocity(x, i) - vertices_[i].force_vector();
  });
}

void AirDrag::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  if (still_ || vertices_.empty()) return;
  parallel_for(x.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      hessian.blocks[at(hessian.pattern->diagonal[i])] += (vertices_[i].damping_matrix() / rate_time_).cast<float>();
  });
}

}  // namespace ft

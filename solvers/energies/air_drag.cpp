#include "solvers/energies/air_drag.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "baker/core/smooth_step.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;

/// Share of the flow that stays on a plate: all of it below 15 degrees, nothing from 25 on.
double attached(double normal, double tangential) {
  constexpr double k_first = 0.2679, k_last = 0.4663;  // tangents
  return smooth_step((k_last * tangential - normal) / ((k_last - k_first) * tangential + 1e-30));
}

}  // namespace

AirDrag::AirDrag(const ClothTopology& topology, const AirSettings& air) : air_(air) {
  for (const ClothPiece& piece : topology.pieces) {
    const double factor = 0.5 * air.density / 3;
    const Fabric& fabric = piece.fabric;
    factors_.push_back({factor * fabric.drag_normal, factor * fabric.drag_tangential, factor * fabric.lift,
                        air.density / 3 * fabric.added_mass});
    const Factors& f = factors_.back();
    still_ = still_ && f.normal == 0 && f.tangential == 0 && f.lift == 0 && f.mass == 0;
  }
  if (still_) return;
  const TriangleOrder& order = triangle_order(topology);
  slots_ = order.slots;
  area_.reserve(order.triangle.size());
  for (const std::size_t t : order.triangle) area_.push_back(static_cast<float>(topology.rest_area[t]));
}

AirDrag::Drag AirDrag::panel(const Triangle& t, double area, const Factors& factors, const StepContext& context,
                             const AirNow* wind) const {
  Vec3 corner[3], place = Vec3::Zero(), motion = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& v = context.v_t0[at(t[k])];
    corner[k] = context.x_t0[at(t[k])] + context.h * v;
    motion += v / 3;
    place += corner[k] / 3;
  }
  Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double length = normal.norm();
  if (!(length > 1e-30)) return {};
  normal /= length;
  const Vec3 air = wind == nullptr ? Vec3::Zero() : wind->velocity(place), velocity = motion - air;
  const Vec3 vn = normal * normal.dot(velocity), vt = velocity - vn;
  const double dn = area * factors.normal * vn.norm(), dt = area * factors.tangential * vt.norm();
  const Mat3 across = normal * normal.transpose();
  // Linear in vn as it is.
  const double lift = factors.lift > 0 ? area * factors.lift * vt.norm() * attached(vn.norm(), vt.norm()) : 0;
  const double layer = area * factors.mass / context.h;
  const Mat3 damping = (2 * dn + lift + layer) * across + 2 * dt * (Mat3::Identity() - across);
  // -(D (v - w) - dn vn - dt vt) at v = 0; the layer has the velocity that it has.
  const Vec3 force = damping * air + dn * vn + dt * vt + layer * vn;
  const auto entry = [](double value) { return static_cast<float>(value); };
  return {{entry(damping(0, 0)), entry(damping(1, 1)), entry(damping(2, 2)), entry(damping(0, 1)), entry(damping(1, 2)),
           entry(damping(2, 0))},
          {entry(force[0]), entry(force[1]), entry(force[2])}};
}

AirDrag::Drag& AirDrag::Drag::operator+=(const Drag& other) {
  for (std::size_t k = 0; k < damping.size(); ++k) damping[k] += other.damping[k];
  for (std::size_t k = 0; k < force.size(); ++k) force[k] += other.force[k];
  return *this;
}

Mat3f AirDrag::Drag::damping_matrix() const {
  const auto& [xx, yy, zz, xy, yz, zx] = damping;
  return Mat3f{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}};
}

Vec3 AirDrag::Drag::damping_times(const Vec3& v) const {
  const auto& [xx, yy, zz, xy, yz, zx] = damping;
  return {xx * v.x() + xy * v.y() + zx * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
          zx * v.x() + yz * v.y() + zz * v.z()};
}

Vec3 AirDrag::Drag::force_vector() const {
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
  x_t0_ = context.x_t0;
  x_tm1_ = context.x_tm1;
  a_ = context.a;
  b_ = context.has_history() ? context.b : 0;
  vertices_.assign(context.x_t0.size(), Drag{});
  const std::unique_ptr<AirNow> wind = air_.wind && !air_.wind->is_still() ? air_.wind->at_time(context.time) : nullptr;
  for_each_chunk(slots_->schedule, [&](std::size_t begin, std::size_t end) {
    GroupIndices<3>::Group corners;
    for (std::size_t i = begin; i < end; ++i) {
      slots_->vertices.get(i, corners);
      for (std::size_t l = 0; l < slots_->schedule.used(i); ++l) {
        const Triangle t{corners.column[0][l], corners.column[1][l], corners.column[2][l]};
        const std::size_t slot = i * k_lanes + l;
        const Drag of_panel = panel(t, area_[slot], factors_[slots_->piece[slot]], context, wind.get());
        for (const int v : t) vertices_[at(v)] += of_panel;
      }
    }
  });
}

double AirDrag::value(std::span<const Vec3> x) const {
  if (still_ || vertices_.empty()) return 0;
  return parallel_sum(x.size(), k_block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 v = velocity(x, i);
      sum += rate_time_ * v.dot(0.5 * vertices_[i].damping_times(v) - vertices_[i].force_vector());
    }
    return sum;
  });
}

void AirDrag::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  if (still_ || vertices_.empty()) return;
  parallel_for(x.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      gradient[i] += vertices_[i].damping_times(velocity(x, i)) - vertices_[i].force_vector();
  });
}

void AirDrag::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  if (still_ || vertices_.empty()) return;
  parallel_for(x.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      hessian.blocks[at(hessian.pattern->diagonal[i])] +=
          vertices_[i].damping_matrix() / static_cast<float>(rate_time_);
  });
}

}  // namespace ft::inline solvers

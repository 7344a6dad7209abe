#include "solvers/energies/seams.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/energies/limited_spring.h"

namespace ft {
namespace {

constexpr double k_no_length = 1e-12;  ///< a spring shorter than this has no direction [m]

Vec3 gap(const SeamPoint& p, std::span<const Vec3> x) {
  return x[at(p.vertex)] - (1 - p.place) * x[at(p.edge[0])] - p.place * x[at(p.edge[1])];
}

std::array<double, 3> weights(const SeamPoint& p) {
  return {1, p.place - 1, -p.place};
}

}  // namespace

Seams::Seams(const ClothTopology& topology) : points_(topology.seams), targets_(points_.size()) {
  for (const SeamPoint& p : points_) {
    CHECK(p.stiffness > 0 && p.pull > 0 && p.hold > 0);
    stencils_.push_back({p.vertex, p.edge[0], p.edge[1], -1});
  }
  for (std::size_t i = 0; i < points_.size(); ++i) targets_[i] = {0, points_[i].hold};
  slots_.resize(points_.size());
  std::iota(slots_.begin(), slots_.end(), 0);
}

void Seams::begin_step(const StepContext& context) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SeamPoint& p = points_[i];
    const double lasts = p.closed_at - p.opens_at;
    const double done = lasts > 0 ? (context.time - p.opens_at) / lasts : (context.time < p.closed_at ? 0.0 : 2.0);
    // After the seam has closed, its limit grows over as long a time as it took.
    targets_[i] = {p.start_gap * std::clamp(1 - done, 0.0, 1.0),
                   p.pull + (p.hold - p.pull) * std::clamp(done - 1, 0.0, 1.0)};
  }
}

double Seams::value(std::span<const Vec3> x) const {
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i)
    sum +=
        limited_spring(gap(points_[i], x).norm() - targets_[i].length, points_[i].stiffness, targets_[i].limit).energy;
  return sum;
}

void Seams::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec3 d = gap(points_[i], x);
    const double length = d.norm();
    if (length < k_no_length) continue;
    const LimitedSpring pull = limited_spring(length - targets_[i].length, points_[i].stiffness, targets_[i].limit);
    const auto w = weights(points_[i]);
    for (std::size_t k = 0; k < 3; ++k) gradient[at(stencils_[i][k])] += (w[k] * pull.force / length) * d;
  }
}

void Seams::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  positions_.bind(*hessian.pattern, stencils_, slots_);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec3 d = gap(points_[i], x);
    const double length = d.norm();
    const LimitedSpring pull = limited_spring(length - targets_[i].length, points_[i].stiffness, targets_[i].limit);
    Mat3 k = Mat3::Identity() * points_[i].stiffness;
    if (length >= k_no_length) {
      const Mat3 along = d * d.transpose() / (length * length);
      k = pull.secant * along + (pull.force / length) * (Mat3::Identity() - along);
    } else if (targets_[i].length > 0) {
      continue;
    }
    const auto w = weights(points_[i]);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        hessian.blocks[at(positions_[i][3 * a + b])] += (w[a] * w[b] * k).cast<float>();
  }
}

}  // namespace ft

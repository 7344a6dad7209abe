#include "collision/broad_phase/vertex_box.h"

#include <algorithm>
#include <cmath>

namespace ft::inline collision {
namespace {

/// Steps from the middle of the frame to its bounds; a sixth more is left beyond.
constexpr double k_steps = 28000;
constexpr double k_most = VertexBox::k_endless;
/// Of the larger part of a sum that its rounding may change.
constexpr double k_rounding = 1e-15;

constexpr std::array<std::array<double, 3>, 8> k_axes{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}, {0, 0, 0}}};
/// What a ball of radius 1 reaches along an axis, rounded up.
constexpr std::array<double, 8> k_reach{
    1, 1, 1, 1.7320508075688774, 1.7320508075688774, 1.7320508075688774, 1.7320508075688774, 0};

inline double along(std::size_t k, const Vec3& p) {
  return k_axes[k][0] * p[0] + k_axes[k][1] * p[1] + k_axes[k][2] * p[2];
}

}  // namespace

double along_box_axis(std::size_t k, const Vec3& p) {
  return along(k, p);
}

VertexBox VertexBox::nowhere() {
  VertexBox out;
  out.lo.fill(k_nowhere);
  out.minus_hi.fill(k_nowhere);
  return out;
}

void VertexBox::include(const VertexBox& other) {
  for (std::size_t k = 0; k < 8; ++k) {
    lo[k] = std::min(lo[k], other.lo[k]);
    minus_hi[k] = std::min(minus_hi[k], other.minus_hi[k]);
  }
}

BoxFrame::BoxFrame(const Vec3& lo, const Vec3& hi) {
  Vec3 half = 0.5 * (hi - lo), middle = 0.5 * (lo + hi);
  if (!half.allFinite() || !middle.allFinite() || half.minCoeff() < 0 || !(half.maxCoeff() > 0)) {
    half.setConstant(0.5);
    middle.setZero();
  }
  for (std::size_t k = 0; k < 8; ++k) {
    origin_[k] = along(k, middle);
    double extent = 0;
    for (int i = 0; i < 3; ++i) extent += std::abs(k_axes[k][at(i)]) * half[i];
    step_[k] = std::max(extent, half.maxCoeff()) / k_steps;  // of x, y and z the same
    per_step_[k] = 1 / step_[k];
  }
}

VertexBox BoxFrame::swept(const Vec3& a, const Vec3& b, double r) const {
  // Of the sums, of what they are less than the origin, and of the quotients.
  const double magnitude = a.lpNorm<1>() + b.lpNorm<1>() + r;
  std::array<double, 8> from, to;
  for (std::size_t k = 0; k < 8; ++k) {
    const double one = along(k, a) - origin_[k], other = along(k, b) - origin_[k];
    const double more = k_reach[k] * r + k_rounding * (magnitude + std::abs(origin_[k]));
    from[k] = per_step_[k] * (std::min(one, other) - more) - 1e-6;
    to[k] = -per_step_[k] * (std::max(one, other) + more) - 1e-6;
  }
  VertexBox out;
  for (std::size_t k = 0; k < 8; ++k) {
    // Not a number is everywhere.
    out.lo[k] = static_cast<std::int16_t>(from[k] > -k_most ? std::min(std::floor(from[k]), k_most) : -k_most);
    out.minus_hi[k] = static_cast<std::int16_t>(to[k] > -k_most ? std::min(std::floor(to[k]), k_most) : -k_most);
  }
  return out;
}

BoxMargin BoxFrame::margin(double r) const {
  BoxMargin out{};
  for (std::size_t k = 0; k < k_box_axes; ++k)
    out[k] = static_cast<std::int16_t>(std::clamp(std::floor(per_step_[k] * k_reach[k] * r * (1 - 1e-9)), 0.0, k_most));
  return out;
}

BoxFrame frame_around(std::span<const Vec3> x, std::span<const Vec3> d, double margin) {
  Box box = bounds(x);
  for (std::size_t i = 0; i < d.size(); ++i) box.include((x[i] + d[i]).eval());
  box.inflate(margin);
  return x.empty() ? BoxFrame() : BoxFrame(box.lo, box.hi);
}

}  // namespace ft::inline collision

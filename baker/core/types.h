// The few mathematical words that every floor shares. SI units everywhere: metres, kilograms, seconds, radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace ft {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3 = Eigen::Matrix3d;
using Mat3f = Eigen::Matrix3f;
using Mat4 = Eigen::Matrix4d;
using Quat = Eigen::Quaterniond;
using Triangle = std::array<int, 3>;
using Edge = std::array<int, 2>;  ///< always (smaller, larger)

/// Indices are int in data and std::size_t in containers; this is the step between. i >= 0.
constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Standard gravity [m/s2]; the world is Y-up inside the program.
inline constexpr double k_gravity = 9.80665;

/// Axis-aligned box; empty when lo > hi.
struct Box {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 hi = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void include(const Vec3& p) { lo = lo.cwiseMin(p), hi = hi.cwiseMax(p); }
  void include(const Box& b) { lo = lo.cwiseMin(b.lo), hi = hi.cwiseMax(b.hi); }
  void inflate(double r) { lo.array() -= r, hi.array() += r; }
  bool empty() const { return !(lo.array() <= hi.array()).all(); }
  bool overlaps(const Box& b) const { return (lo.array() <= b.hi.array()).all() && (b.lo.array() <= hi.array()).all(); }
  Vec3 size() const { return empty() ? Vec3::Zero().eval() : (hi - lo).eval(); }
};

Box bounds(std::span<const Vec3> points);

/// True when no coordinate is NaN or infinite.
bool all_finite(std::span<const Vec3> points);

}  // namespace ft

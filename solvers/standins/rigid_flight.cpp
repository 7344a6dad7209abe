#include "solvers/standins/rigid_flight.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

constexpr double k_angle_per_step = 0.01;  ///< rad; an error of 1e-10 rad in a turn

}  // namespace

Mat3 world_inertia(const RigidMass& mass, const Quat& rotation) {
  const Mat3 r = rotation.toRotationMatrix();
  return r * mass.inertia * r.transpose();
}

Quat rotation_by(const Vec3& vector) {
  const double angle = vector.norm();
  const double half = 0.5 * angle, factor = angle > 1e-8 ? std::sin(half) / angle : 0.5 - half * half / 12;
  Quat out;
  out.w() = std::cos(half);
  out.vec() = factor * vector;
  return out.normalized();
}

Vec3 rotation_vector(const Quat& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1, sine = rotation.vec().norm();
  if (sine == 0) return Vec3::Zero();
  return sign * 2 * std::atan2(sine, std::abs(rotation.w())) / sine * rotation.vec();
}

RigidFlight::RigidFlight(const RigidMotion& release, const RigidMass& mass, const Vec3& gravity)
    : release_(release),
      gravity_(gravity),
      inverse_inertia_(mass.inertia.inverse()),
      angular_momentum_(world_inertia(mass, release.pose.rotation) * release.spin),
      is_spherical_(mass.inertia.isApprox(mass.inertia(0, 0) * Mat3::Identity(), 1e-12)) {
  CHECK(mass.inertia(0, 0) > 0);
}

RigidMotion RigidFlight::at(double time) const {
  RigidMotion out = release_;
  out.pose.position += time * release_.velocity + 0.5 * time * time * gravity_;
  out.velocity += time * gravity_;
  if (is_spherical_) {
    out.pose.rotation = rotation_by(time * release_.spin) * release_.pose.rotation;
    return out;
  }
  const auto spin = [&](const Quat& q) { return Vec3(q * (inverse_inertia_ * (q.conjugate() * angular_momentum_))); };
  const auto rate = [&](const Quat& q) {  // dq/dt = omega q / 2, q of unit length
    const Vec3 w = 0.5 * spin(q.normalized());
    return (Quat(0, w.x(), w.y(), w.z()) * q).coeffs().eval();
  };
  const auto moved = [](const Quat& q, const Eigen::Vector4d& by) { return Quat(Eigen::Vector4d(q.coeffs() + by)); };
  // The momentum bounds the spin: no pose makes it faster than about the axis of least inertia.
  const double fastest = inverse_inertia_.norm() * angular_momentum_.norm();
  const auto steps = static_cast<long>(std::max(1.0, std::ceil(std::abs(time) * fastest / k_angle_per_step)));
  const double h = time / static_cast<double>(steps);
  Quat q = release_.pose.rotation;
  for (long i = 0; i < steps; ++i) {
    const Eigen::Vector4d k1 = rate(q), k2 = rate(moved(q, 0.5 * h * k1)), k3 = rate(moved(q, 0.5 * h * k2)),
                          k4 = rate(moved(q, h * k3));
    q = moved(q, h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)).normalized();
  }
  out.pose.rotation = q;
  out.spin = spin(q);
  return out;
}

}  // namespace ft::inline solvers

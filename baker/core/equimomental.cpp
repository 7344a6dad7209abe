#include "baker/core/equimomental.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace ft {
namespace {

/// Thinnest that a body may be against its longest extent: the four points must span space [1].
constexpr double k_thinnest = 1e-3;

Mat3 inertia_of(const Mat3& second_moment) {
  return second_moment.trace() * Mat3::Identity() - second_moment;
}

/// From measure, first and second moment about the origin.
BodyMass scaled(double measure, const Vec3& first, const Mat3& second, double kilograms) {
  BodyMass out;
  if (!(std::abs(measure) > 0)) return out;
  out.centre = first / measure;
  const Mat3 about_centre = second / measure - out.centre * out.centre.transpose();
  out.mass = {kilograms, inertia_of(kilograms * about_centre)};
  return out;
}

}  // namespace

std::array<double, 4> Equimomental::weights(const Vec3& p) const {
  Eigen::Matrix4d all;
  for (int k = 0; k < 4; ++k) all.col(k) << node[at(k)], 1;
  const Eigen::Vector4d w = all.partialPivLu().solve(Eigen::Vector4d(p.x(), p.y(), p.z(), 1));
  return {w[0], w[1], w[2], w[3]};
}

RigidPose Equimomental::pose(std::span<const Vec3, 4> nodes) const {
  RigidPose out;
  for (const Vec3& p : nodes) out.position += 0.25 * p;
  Mat3 spread = Mat3::Zero();
  for (std::size_t k = 0; k < 4; ++k) spread += (nodes[k] - out.position) * node[k].transpose();
  out.rotation = Quat(nearest_rotation(spread)).normalized();
  return out;
}

std::array<Vec3, 4> Equimomental::place(const RigidPose& pose) const {
  std::array<Vec3, 4> out;
  for (std::size_t k = 0; k < 4; ++k) out[k] = pose * node[k];
  return out;
}

RigidMotion Equimomental::motion(std::span<const Vec3, 4> nodes, std::span<const Vec3, 4> velocities) const {
  RigidMotion out;
  out.pose = pose(nodes);
  for (const Vec3& v : velocities) out.velocity += 0.25 * v;
  Mat3 inertia = Mat3::Zero();
  Vec3 momentum = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 arm = nodes[k] - out.pose.position;
    inertia += inertia_of(arm * arm.transpose());
    momentum += arm.cross(velocities[k]);
  }
  out.spin = inertia.ldlt().solve(momentum);
  return out;
}

Equimomental equimomental(const RigidMass& mass) {
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(0.5 * (mass.inertia + mass.inertia.transpose()));
  const Vec3 moment = principal.eigenvalues();
  Vec3 half;
  for (int i = 0; i < 3; ++i) half[i] = std::sqrt(std::max(0.0, (0.5 * moment.sum() - moment[i]) / mass.mass));
  half = half.cwiseMax(k_thinnest * half.maxCoeff());
  Equimomental out;
  constexpr std::array<std::array<int, 3>, 4> corner{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
  for (std::size_t k = 0; k < 4; ++k)
    out.node[k] =
        principal.eigenvectors() * Vec3(corner[k][0] * half[0], corner[k][1] * half[1], corner[k][2] * half[2]);
  return out;
}

BodyMass filled_mass(std::span<const Vec3> x, std::span<const Triangle> triangles, double kilograms) {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : triangles) {
    const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
    const double v = a.dot(b.cross(c)) / 6;  // of the tetrahedron with the origin
    const Vec3 sum = a + b + c;
    volume += v;
    first += v / 4 * sum;
    second += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  return scaled(volume, first, second, kilograms);
}

BodyMass hollow_mass(std::span<const Vec3> x, std::span<const Triangle> triangles, double kilograms) {
  double area = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : triangles) {
    const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
    const double s = triangle_area(a, b, c);
    const Vec3 sum = a + b + c;
    area += s;
    first += s / 3 * sum;
    second += s / 12 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  return scaled(area, first, second, kilograms);
}

}  // namespace ft

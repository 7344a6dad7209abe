#include "io/import/body/dual_quaternions.h"

#include <Eigen/LU>
#include <algorithm>

namespace ft::inline io {

RigidPart rigid_part(const Eigen::Matrix<double, 3, 4>& matrix) {
  RigidPart out;
  Mat3 axes = matrix.leftCols<3>();
  out.scale = axes.colwise().norm().transpose();
  for (int k = 0; k < 3; ++k)
    if (out.scale[k] > 0) axes.col(k) /= out.scale[k];
  if (axes.determinant() < 0) {
    axes.col(0) = -axes.col(0);
    out.scale[0] = -out.scale[0];
  }
  const Quat rotation(axes);
  const double length = rotation.norm();
  if (length > 1e-9) out.rotation.coeffs() = rotation.coeffs() / length;
  const Vec3 half = 0.5 * matrix.col(3);
  out.dual = Quat(0, half.x(), half.y(), half.z()) * out.rotation;
  return out;
}

Vec3 dual_blend(std::span<const RigidPart> parts, std::span<const int> bones, std::span<const double> weights,
                const Vec3& point) {
  const auto part = [&](std::size_t k) -> const RigidPart& { return parts[static_cast<std::size_t>(bones[k])]; };
  const auto heaviest = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  const Eigen::Vector4d first = part(heaviest).rotation.coeffs();
  Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = Eigen::Vector4d::Zero();
  Vec3 scale = Vec3::Zero();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const RigidPart& p = part(k);
    const double w = p.rotation.coeffs().dot(first) < 0 ? -weights[k] : weights[k];
    real += w * p.rotation.coeffs();
    dual += w * p.dual.coeffs();
    scale += weights[k] * p.scale;
  }
  const double length = real.norm();
  if (!(length > 1e-12)) {  // opposite rotations that cancel: the heaviest alone
    real = first, dual = part(heaviest).dual.coeffs();
  } else {
    real /= length, dual /= length;
  }
  const Quat rotation(real[3], real[0], real[1], real[2]);
  const Quat moved = Quat(dual[3], dual[0], dual[1], dual[2]) * rotation.conjugate();
  return rotation * scale.cwiseProduct(point) + 2 * moved.vec();
}

}  // namespace ft::inline io

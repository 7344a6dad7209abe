#include "baker/core/rigid.h"

#include <Eigen/Dense>

namespace ft {

Mat3 nearest_rotation(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 mirror = Mat3::Identity();
  mirror(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * mirror * svd.matrixV().transpose();
}

Eigen::Isometry3d rigid_fit(std::span<const Vec3> from, std::span<const Vec3> to) {
  const auto count = static_cast<double>(from.size());
  Vec3 from_middle = Vec3::Zero(), to_middle = Vec3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) from_middle += from[i], to_middle += to[i];
  if (!from.empty()) from_middle /= count, to_middle /= count;
  Mat3 correlation = Mat3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i)
    correlation += (to[i] - to_middle) * (from[i] - from_middle).transpose();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = nearest_rotation(correlation);
  out.translation() = to_middle - out.linear() * from_middle;
  return out;
}

}  // namespace ft

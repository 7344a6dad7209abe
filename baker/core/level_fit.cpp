#include "baker/core/level_fit.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ft {

Eigen::Isometry3d level_fit(std::span<const Vec3> from, std::span<const Vec3> to) {
  Vec3 from_middle = Vec3::Zero(), to_middle = Vec3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) from_middle += from[i], to_middle += to[i];
  if (!from.empty()) from_middle /= static_cast<double>(from.size()), to_middle /= static_cast<double>(from.size());
  double along = 0, across = 0;  // of the turn that brings the points' level places together
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 a = from[i] - from_middle, b = to[i] - to_middle;
    along += a.x() * b.x() + a.z() * b.z();
    across += a.z() * b.x() - a.x() * b.z();
  }
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = Eigen::AngleAxisd(std::atan2(across, along), Vec3::UnitY()).toRotationMatrix();
  Vec3 way = to_middle - out.linear() * from_middle;
  way.y() = 0;
  out.translation() = way;
  return out;
}

}  // namespace ft

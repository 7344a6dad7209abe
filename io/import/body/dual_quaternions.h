// Dual quaternion skinning (Kavan, Collins, Žára, O'Sullivan 2007, "Skinning with dual quaternions"): rotations and
// translations are blended as dual quaternions, which keeps the volume where linear blending pinches it. Scales along
// the axes are blended linearly and applied before the rotation, as Maya's FBX files are drawn by other readers; shear
// is left out.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "baker/core/types.h"

namespace ft::inline io {

/// matrix = translation * rotation * scale, of a matrix without shear.
struct RigidPart {
  Quat rotation = Quat::Identity();
  Quat dual = Quat(0, 0, 0, 0);  ///< half the translation times the rotation
  Vec3 scale = Vec3::Ones();     ///< the first is negative in a reflection
};

RigidPart rigid_part(const Eigen::Matrix<double, 3, 4>& matrix);

/// Where the blend of parts puts a point. Of two rotations that are one (q and -q) the one nearer to that of the
/// heaviest bone counts. Weights sum to 1.
Vec3 dual_blend(std::span<const RigidPart> parts, std::span<const int> bones, std::span<const double> weights,
                const Vec3& point);

}  // namespace ft::inline io

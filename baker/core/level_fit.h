// The motion of something that stands on the ground, from points of it.
#pragma once

#include <span>

#include "baker/core/types.h"

namespace ft {

/// The turn about the vertical (y) and the level way that take `from` nearest to `to`, by least squares. As many points
/// in both.
Eigen::Isometry3d level_fit(std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace ft

// A T-pose made from a skeleton: arms level to the sides, legs straight down. Joints are turned about themselves only;
// lengths of bones and the twist of each bone stay what they are in the pose that it starts from.
#pragma once

#include <optional>
#include <span>

#include "io/import/body/bind.h"
#include "io/import/body/figure.h"

namespace ft::inline io {

/// How upright a pose is: the cosine between trunk and legs, -1 standing, 1 folded flat; nothing for a skeleton whose
/// trunk or legs are not known or have no length.
std::optional<double> trunk_to_legs(const Character& character, const Figure& figure, std::span<const Mat4> globals);

/// From the middle of the hip joints to the neck, else to the middle of the shoulders; zero where there is no trunk.
Vec3 trunk_of(const Figure& figure, std::span<const Mat4> globals);

enum class TPoseFrom {
  k_standing,  ///< a pose that stands: its trunk, collars and feet stay as they are
  k_any,       ///< trunk, head, collars and feet are set upright, too, facing z
};

/// axes takes the file's axes to Y-up. Joints that the figure does not have are left alone.
BindPose t_pose(const Character& character, const Figure& figure, const BindPose& from, const Mat3& axes,
                TPoseFrom kind);

}  // namespace ft::inline io

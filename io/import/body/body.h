// A body for motion that has none: a closed surface around a skeleton in its rest pose, skinned to the bones.
// Proportions are fractions of the skeleton's height, by the names of the joints, so units do not matter.
#pragma once

#include <span>
#include <string>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Adds one closed mesh for each skeleton (ROOT), in the pose of these globals; none: the rest pose. style: "blended"
/// (one smooth closed surface) or "capsules" (one closed capsule per bone). axes takes the file's axes to Y-up.
Status add_body(Character& character, const std::string& style, const Mat3& axes, std::span<const Mat4> globals = {});

}  // namespace ft::inline io

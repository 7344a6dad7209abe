// A body for motion that has none: a closed surface around a skeleton in its rest pose, skinned to the bones.
// Proportions are fractions of the skeleton's height, by the names of the joints, so units do not matter.
#pragma once

#include <string>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Adds one mesh. style: "blended" (one smooth closed surface) or "capsules" (one closed capsule per bone). axes takes
/// the file's axes to Y-up.
Status add_body(Character& character, const std::string& style, const Mat3& axes);

}  // namespace ft::inline io

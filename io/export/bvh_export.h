// BVH for the animator: a BVH with other values in some channels, all else as it is spelled; or a new one made from the
// skeleton of any character.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "io/import/character/motion_change.h"

namespace ft::inline io {

/// The text of `source` with the changed channels, at its own frames, in its own units, axes and orders of rotation. A
/// number that stays what it is keeps its spelling; without changes all bytes are the same. `character` is what was
/// imported from `source`.
/// Errors: a file that cannot be read, joints that are not the character's nodes, a change that the joint has no
/// channels for.
Result<std::string> export_bvh(const std::filesystem::path& source, const Character& character, int clip,
                               std::span<const ChangedChannel> changes);

struct BvhFrames {
  double start = 0;        ///< time in the clip of the first frame [s]
  double time = 1.0 / 24;  ///< between frames [s]
  int count = 1;
};

/// A BVH of the nodes that bear a skin or move, below the lowest node above all of them, in metres and Y up, rotations
/// in the order Z, X, Y. Joints whose distance to their parent changes get position channels. placement takes file
/// units and axes to metres and Y-up; clip -1 is the rest pose.
Result<std::string> bvh_from_character(const Character& character, int clip, const Mat4& placement,
                                       const BvhFrames& frames);

/// Angles [rad] about three different axes, so that R = R_0(a) R_1(b) R_2(c); of all that do so the nearest to `near`.
Vec3 euler_angles(const Quat& rotation, const std::array<int, 3>& axes, const Vec3& near);

}  // namespace ft::inline io

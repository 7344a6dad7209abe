// A clip on a character with other bones: turns of the joints that both have are carried over in the world, from pose
// to bind pose, and limbs are first brought into line where one stands in a T and the other in an A. For
// sweep_list.cpp. It is what an animator's quick retarget does, and as careless: hands and arms go into bodies that are
// broader.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "io/import/character/character.h"

namespace ft::bench {

inline constexpr int k_common_joints = 21;

/// The joints that all two-legged characters have, found by the names that rigs give them.
struct CommonJoints {
  std::array<int, k_common_joints> node;  ///< -1: it has none
  int count = 0;
  /// Hips, thighs, shins and upper arms at least, each below the one it hangs on.
  bool complete = false;
};
CommonJoints find_joints(const Character& character);

struct RetargetedPart {
  double start = 0, fps = 24;  ///< s in the clip, frames per second
  int frame_count = 0;
};

/// Writes a .glb with the target's node names and one clip, which begins at 0: for the key `animation`. Both characters
/// have complete joints.
Status write_retargeted(const Character& source, const Clip& clip, const RetargetedPart& part, const Character& target,
                        const std::filesystem::path& file);

}  // namespace ft::bench

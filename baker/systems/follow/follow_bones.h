// Joints that follow their animation with a spring's lag. The tip of each joint is a point behind its animated place,
// and the joint turns so that it looks at it. Joints above turn first, so that a lag runs down a tail.
#pragma once

#include <span>
#include <vector>

#include "baker/core/teleport.h"
#include "baker/systems/follow/follow_spec.h"
#include "io/import/character/motion_change.h"
#include "io/import/motion/placed_character.h"

namespace ft::inline baker {

/// When a shot looks at a clip.
struct FollowTiming {
  double fps = 24;
  int first_frame = 1, frame_count = 1;  ///< of the shot
  int preroll_frames = 0;                ///< before that, from which on the lag is followed

  /// Equal steps of a frame that are no longer than `longest` [s].
  int steps(double longest) const;
};

struct FollowedBones {
  std::vector<ChangedChannel> channels;
  std::vector<double> lag;   ///< of each frame of the shot: the largest distance of a tip from its animated place [m]
  std::vector<double> turn;  ///< the same of the angle by which a joint is turned [rad]
};

/// Joints by name, ascending. Error: a pattern that names none, with what may have been meant.
Result<std::vector<int>> joints_like(const std::vector<std::string>& patterns, const Character& character);

/// place: what moves the character in the world behind its placement. teleports: of the shot.
FollowedBones follow_bones(const PlacedCharacter& placed, const Eigen::Isometry3d& place, std::span<const int> joints,
                           const FollowSpec& spec, const FollowTiming& timing, std::span<const Teleport> teleports);

}  // namespace ft::inline baker

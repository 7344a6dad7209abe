// A clip that is played again and again. From one cycle to the next the character goes on from where it has got to: by
// the way of its pelvis on the ground and by the turn of its heading, so that a step becomes a walk. What else differs
// between the end of the clip and its start (pose, height) is the seam; it is measured, not repaired.
#pragma once

#include <string>
#include <vector>

#include "baker/core/types.h"
#include "io/import/motion/placed_character.h"

namespace ft::inline io {

struct Cycle {
  double period = 0;                                       ///< s of the file, > 0
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();  ///< from a cycle to the next: level way, turn about y [m]
  /// Largest distance of a vertex between the end of a cycle and the start of the next one, carried on [m].
  double seam = 0;

  /// step to the power n >= 0.
  Eigen::Isometry3d steps(long n) const;
};

/// The step is the identity where it is less than a millionth of `size` [m] and of a radian.
Cycle make_cycle(double period, const Eigen::Isometry3d& step, double size);

/// Which cycles a shot plays, and where it meets seams.
struct CycleSpan {
  long first = 0, last = 0;      ///< cycles, 0 the one that the file holds
  std::vector<int> seam_frames;  ///< first frame after each seam, of the first k_most_seams
  long seam_count = 0;
};
inline constexpr std::size_t k_most_seams = 10'000;
/// From `clip_start` [s of the clip] on, duration in s of the shot.
CycleSpan cycles_of_shot(const Cycle& cycle, const ImportRequest& request);

/// "its clip of 1 s repeats: ...", and of a seam above k_large_seam of `size` [m] the frames as well.
std::string cycle_note(const Cycle& cycle, const CycleSpan& span, double size);

/// Of the size of a body; what a hand covers in half a frame of a walk.
inline constexpr double k_large_seam = 0.01;

/// Puts as many cycles of the clip as the shot plays in its place, keys and all, so that whatever reads the clip reads
/// the repeated one; says so in the notes. meshes: those of the collider; size: of the bind pose [m]. Errors: a root
/// below a node that is scaled unequally, more keys than a character may have.
Status repeat_clip(PlacedCharacter& placed, const std::vector<int>& meshes, double size, const ImportRequest& request);

}  // namespace ft::inline io

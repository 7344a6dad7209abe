// A character whose bind pose is far from its first frame gets there within the pre-roll, however far that is.
#pragma once

#include <optional>
#include <string>

#include "baker/core/trajectory.h"
#include "io/shot/shot.h"

namespace ft::inline baker {

/// A pre-roll that is much faster than the shot, and fast: cloth is torn at there, and its frames cost many times those
/// of the shot.
struct HastyPreroll {
  double there = 0, here = 0;  ///< fastest vertex of the pre-roll and of the shot [m/s]
  int calm = 0;                ///< how long a pre-roll would do [frames]

  /// A note. taken: the pre-roll that the shot gets instead [frames]; none: it names its own, and keeps it.
  std::string text(const std::string& primary, std::optional<int> taken) const;
};

std::optional<HastyPreroll> hasty_preroll(const Shot& shot, const Trajectory& trajectory);

}  // namespace ft::inline baker

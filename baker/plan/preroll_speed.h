// A character whose bind pose is far from its first frame gets there within the pre-roll, however far that is.
#pragma once

#include <optional>
#include <string>

#include "baker/core/trajectory.h"
#include "io/shot/shot.h"

namespace ft::inline baker {

/// A note where the pre-roll is much faster than the shot, and fast: cloth is torn at there, and its frames cost many
/// times those of the shot. Says how long a pre-roll would do.
std::optional<std::string> hasty_preroll(const Shot& shot, const std::string& primary, const Trajectory& trajectory);

}  // namespace ft::inline baker

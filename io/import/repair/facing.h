// Surfaces that are inside out: closed pieces whose triangles are counter-clockwise seen from within, as a mirrored
// node or a flipped normal leaves them. Contact would push garments into such a body. They are turned, and that is
// said.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

struct FacingReport {
  int piece_count = 0;   ///< closed ones, or nearly so
  int turned_count = 0;  ///< of those
  double volume = 0;     ///< that the turned ones enclose [m3], >= 0

  /// One sentence; empty where nothing was turned.
  std::string text() const;
};

/// Turns the triangles of closed pieces that face inwards. Open pieces have no inside and stay as they are.
FacingReport turn_outwards(std::span<const Vec3> positions, std::vector<Triangle>& triangles);

}  // namespace ft::inline io

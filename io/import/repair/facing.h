// Surfaces that are inside out: closed pieces whose triangles are counter-clockwise seen from within, as a mirrored
// node or a flipped normal leaves them, and pieces of which only a part is, as after mirroring half of a model. Contact
// would push garments into such a body. They are turned, and that is said.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

struct FacingReport {
  int piece_count = 0;   ///< closed ones, or nearly so
  int turned_count = 0;  ///< of those, as a whole
  double volume = 0;     ///< that the turned ones enclose [m3], >= 0
  int disagreeing_count = 0, disagreeing_faces = 0, disagreeing_turned = 0;  ///< pieces, their faces, the turned ones
  int one_sided_count = 0, one_sided_faces = 0;                              ///< pieces that cannot be turned

  /// A sentence for each kind of repair.
  std::vector<std::string> notes() const;
};

/// Makes the faces of a piece agree, over edges of two triangles, and turns closed pieces that face inwards. Open
/// pieces have no inside: where their faces disagree, the larger area has its way.
FacingReport turn_outwards(std::span<const Vec3> positions, std::vector<Triangle>& triangles);

}  // namespace ft::inline io

// Before a bake: how its garments lie where it starts. Cloth that starts through the body or through cloth is sorted
// out in the pre-roll; without one nothing does it. For --dry-run, the log, and the notes of the manifest.
#pragma once

#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline baker {

struct BakePlan;

/// A garment that starts through something, once for each thing.
struct BadStart {
  std::string cloth;
  std::string other;  ///< primary, or cloth, perhaps the same
  bool is_primary = false;
  int crossings = 0;          ///< edges through triangles, exact
  int inside = 0;             ///< vertices inside the body
  double depth = 0;           ///< of the deepest of them [m]
  int vertex = -1;            ///< the deepest, else one that crosses; in file order
  Vec3 place = Vec3::Zero();  ///< of that [m]
};

struct StartReport {
  std::vector<BadStart> bad;  ///< by garment, as in the plan
  int garment_count = 0;
  int preroll = 0;  ///< frames
  double fps = 24;
};

/// Against the feasible collider of the first moment; pairs that a seam holds together, and what is absent for a
/// garment, left out.
StartReport find_start(const BakePlan& plan);

/// One line for each bad start, and one with what becomes of them. Empty where all is well.
std::vector<std::string> start_lines(const StartReport& report);

}  // namespace ft::inline baker

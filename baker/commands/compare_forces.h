// compare, of two bake folders: what each garment did to its primary in the one and in the other, frame by frame. Told
// beside the caches and of no effect on the verdict: forces follow from positions.
#pragma once

#include <string>
#include <vector>

#include "baker/record/manifest.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

struct ForceDifference {
  int frame = 0;
  double a = 0, b = 0;  ///< size of the frame's mean force in each [N]
  double apart = 0;     ///< size of the difference of the two forces [N]
};

struct ForceComparison {
  std::string system, primary;                          ///< primary: empty where the system meets its own alone
  std::vector<ForceDifference> frames;                  ///< those that both have, and in which it touched in either
  double mean_a = 0, mean_b = 0, max_a = 0, max_b = 0;  ///< over these frames [N]
  int worst = -1;                                       ///< index of the largest difference; -1: no frames
};

/// Of the garments that both have, and the primaries that they meet in both, in a's order; only written frames.
std::vector<ForceComparison> compare_forces(const Manifest& a, const Manifest& b);

/// A line each; empty where nothing touched.
std::string to_text(const std::vector<ForceComparison>& forces);
Json to_json(const std::vector<ForceComparison>& forces);

}  // namespace ft::inline baker

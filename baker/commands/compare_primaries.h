// compare, of two bake folders: how far apart the primaries went, which is what a coupling changes. Told beside the
// caches and of no effect on the verdict: the drawn bodies are caches, too.
#pragma once

#include <string>
#include <vector>

#include "baker/record/primary_paths.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

struct PathComparison {
  std::string primary;
  double largest = 0;                                         ///< distance of its centres [m]
  int frame = 0;                                              ///< where that is
  Vec3 velocity_a = Vec3::Zero(), velocity_b = Vec3::Zero();  ///< in the last frame [m/s]
};

/// Of the primaries that both have, over the frames that both have.
std::vector<PathComparison> compare_primaries(const std::vector<PrimaryPath>& a, const Manifest& manifest_a,
                                              const std::vector<PrimaryPath>& b, const Manifest& manifest_b);

/// A line each.
std::string to_text(const std::vector<PathComparison>& paths);
Json to_json(const std::vector<PathComparison>& paths);

}  // namespace ft::inline baker

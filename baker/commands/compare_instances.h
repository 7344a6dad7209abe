// compare, of caches of instances: who is who goes by id, whatever their order. Positions in metres as of meshes, and
// rotations in degrees beside them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

struct CompareReport;

/// What there is to say of instances that meshes do not have.
struct InstanceDifference {
  std::vector<std::uint64_t> ids;       ///< of a, in its order; FrameDifference::vertex is an index into them
  int common = 0;                       ///< ids that both have
  std::vector<std::uint64_t> missing;   ///< ids that only a has, ascending
  std::vector<std::uint64_t> extra;     ///< ids that only b has, ascending
  std::vector<std::uint64_t> replaced;  ///< ids that are copies of another prototype in b, ascending
  double p95 = 0;                       ///< of the distances, over all frames and instances [m]
  double turn_rms = 0, turn_p95 = 0, turn_max = 0;  ///< angles between orientations, over the same [degrees]
  double scale_max = 0;                             ///< largest difference of scales [1]

  bool same_set() const { return missing.empty() && extra.empty() && replaced.empty(); }
};

/// Fills the frames and `instances` of a report, whose range has been compared; both caches hold instances. A scale
/// counts as the distance that it makes on a prototype of 1 m. Error: a frame that cannot be read.
Status compare_instances(CacheReader& a, CacheReader& b, CompareReport& report);

/// Lines under the pair's own: counts, missing and extra ids, positions, rotations.
std::string instances_text(const CompareReport& report);

}  // namespace ft::inline baker

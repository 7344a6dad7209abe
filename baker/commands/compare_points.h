// compare, of caches of points that come and go, which are droplets: who is who goes by id, frame by frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "baker/core/result.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

struct CompareReport;

/// What there is to say of points that meshes do not have. Counts are sums over all frames.
struct PointDifference {
  std::vector<std::uint64_t> ids;                  ///< FrameDifference::vertex and speed_vertex are indices of it
  std::size_t common = 0, missing = 0, extra = 0;  ///< in both; only in a; only in b
  int first_other_set = -1;                        ///< frame in which the two first hold other points; -1: in none
  double p95 = 0;                                  ///< of the distances [m]
  double width_max = 0;                            ///< largest difference of widths [m]

  bool same_set() const { return missing == 0 && extra == 0; }
};

/// Fills the frames and `points` of a report, whose range has been compared; both caches hold points. Error: a frame
/// that cannot be read.
Status compare_points(CacheReader& a, CacheReader& b, CompareReport& report);

/// Lines under the pair's own: counts, distances, widths.
std::string points_text(const CompareReport& report);

}  // namespace ft::inline baker

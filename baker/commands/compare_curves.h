// compare, of caches of curves, which are strands of hair: who is who goes by id where both have ids, else by index.
// Beside distances of vertices: how far roots are apart, which should follow the same body, and in each cache how long
// strands are against their rest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

struct CompareReport;

/// Lengths of the strands of one cache in all frames, by their lengths at rest.
struct LengthRatios {
  std::size_t count = 0;  ///< strands that have a length at rest, times frames
  double mean = 1;
  double p99 = 0;    ///< of |ratio - 1|
  double worst = 1;  ///< the ratio that is farthest from 1
  int worst_frame = 0;
  std::uint64_t worst_strand = 0;  ///< id, or index where there are none
};

/// What there is to say of curves that meshes do not have.
struct CurveDifference {
  bool by_id = false;                  ///< else by index, in all that follows
  std::vector<std::uint64_t> ids;      ///< of a's strands, in its order
  std::vector<int> starts;             ///< of a's strands, their first vertices; FrameDifference::vertex is one of a's
  int common = 0;                      ///< strands that both have
  std::vector<std::uint64_t> missing;  ///< ids that only a has, ascending
  std::vector<std::uint64_t> extra;    ///< ids that only b has, ascending
  std::vector<std::uint64_t> resized;  ///< ids that have another number of vertices in b, ascending; not compared
  double p95 = 0;                      ///< of the distances, over all frames and vertices [m]
  double root_max = 0;                 ///< largest distance of roots [m]
  int root_frame = 0;                  ///< where that is
  std::uint64_t root_strand = 0;
  LengthRatios lengths_a, lengths_b;  ///< of all strands of each

  bool same_set() const { return missing.empty() && extra.empty() && resized.empty(); }
  /// Of a vertex of a: its strand, an index into ids and starts.
  std::size_t strand_of(int vertex) const;
  /// "strand 1004, vertex 7", of a vertex of a.
  std::string element(int vertex) const;
};

/// Fills the frames and `curves` of a report, whose range has been compared; both caches hold curves. Error: a frame
/// that cannot be read.
Status compare_curves(CacheReader& a, CacheReader& b, CompareReport& report);

/// Lines under the pair's own: counts, missing and extra ids, vertices, roots, lengths.
std::string curves_text(const CompareReport& report);

}  // namespace ft::inline baker

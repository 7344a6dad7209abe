// Scalars of vertices in a comparison of meshes: those that both caches have, by their names.
#pragma once

#include <string>
#include <vector>

#include "io/cache/cache.h"

namespace ft::inline baker {

struct CompareReport;
struct FrameDifference;

/// Of the scalars of a name, over all frames.
struct ScalarDifference {
  std::string name;
  std::size_t in_a = 0, in_b = 0;  ///< which of each cache's
  double max = 0;
  int frame = 0, vertex = -1;  ///< where; -1: all are bit-equal
};

struct ScalarsDifference {
  std::vector<ScalarDifference> both;
  std::vector<std::string> only_a, only_b;  ///< not compared
};

ScalarsDifference paired_scalars(const CacheInfo& a, const CacheInfo& b);
/// A frame into both; f.frame is set.
void compare_scalars(const FrameData& a, const FrameData& b, ScalarsDifference& all, FrameDifference& f);
/// For the report; empty where neither has any.
std::string scalars_text(const ScalarsDifference& all);

}  // namespace ft::inline baker

// Pairs that touch on their carried way, and when the first of them does, put together by several threads. For
// candidates.cpp and candidates_carried.cpp.
#pragma once

#include <algorithm>
#include <mutex>

#include "solvers/cloth/advance/candidates.h"

namespace ft::inline solvers {

struct Candidates::Touching {
  ContactPairs pairs;   ///< in any order until sort()
  double earliest = 1;  ///< of the motion [1]

  std::vector<Stencil>& of(PairKind kind) {
    return kind == PairKind::k_vertex_face ? pairs.vertex_face : pairs.edge_edge;
  }
  /// A pair and when it touches; from 1 on it does not.
  void take(PairKind kind, const Stencil& pair, double time) {
    if (!(time < 1)) return;
    const std::lock_guard lock(mutex_);
    of(kind).push_back(pair);
    earliest = std::min(earliest, time);
  }
  void sort() {
    std::sort(pairs.vertex_face.begin(), pairs.vertex_face.end());
    std::sort(pairs.edge_edge.begin(), pairs.edge_edge.end());
  }

 private:
  std::mutex mutex_;
};

}  // namespace ft::inline solvers

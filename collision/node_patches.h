// For the nodes of a tree over triangles: which patches everything below a node is in. Two nodes that have a patch in
// common need not be looked at where the patch is skipped. For fcl_pair_finder.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft {

class NodePatches {
 public:
  bool built() const { return !start_.empty(); }

  /// first_child(node): negative for the leaf -1 - it, else that child and the next, which come behind their parents.
  /// of_leaf(leaf): its patches, ascending.
  template <class FirstChild, class OfLeaf>
  void build(std::size_t nodes, FirstChild&& first_child, OfLeaf&& of_leaf) {
    std::vector<std::vector<int>> lists(nodes);
    std::size_t sum = 0;
    for (std::size_t k = nodes; k-- > 0;) {
      const int child = first_child(k);
      if (child < 0) {
        const std::span<const int> own = of_leaf(-1 - child);
        lists[k].assign(own.begin(), own.end());
      } else {
        const std::vector<int>&a = lists[at(child)], &b = lists[at(child) + 1];
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(lists[k]));
      }
      sum += lists[k].size();
    }
    start_.assign(1, 0);
    start_.reserve(nodes + 1);
    items_.clear();
    items_.reserve(sum);
    for (const std::vector<int>& list : lists) {
      items_.insert(items_.end(), list.begin(), list.end());
      start_.push_back(static_cast<int>(items_.size()));
    }
  }

  /// Whether everything below a node is in one of the skipped patches.
  bool any(int node, std::span<const char> skipped) const {
    for (int i = start_[at(node)]; i < start_[at(node) + 1]; ++i)
      if (skipped[at(items_[at(i)])] != 0) return true;
    return false;
  }
  /// Whether everything below two nodes is.
  bool any_common(int a, int b, std::span<const char> skipped) const {
    int i = start_[at(a)], j = start_[at(b)];
    const int end_i = start_[at(a) + 1], end_j = start_[at(b) + 1];
    while (i < end_i && j < end_j) {
      const int p = items_[at(i)], q = items_[at(j)];
      if (p == q && skipped[at(p)] != 0) return true;
      i += p <= q;
      j += q <= p;
    }
    return false;
  }

 private:
  std::vector<int> start_, items_;
};

}  // namespace ft

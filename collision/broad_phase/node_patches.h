// For the nodes of a tree over triangles, and the triangles: which patches everything below a node is in. Two nodes
// that have a patch in common need not be looked at where the patch is skipped. Neighbours are mostly in the same
// patches, so equal sets of patches are kept once. For pair_finder.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/types.h"
#include "collision/broad_phase/pair_node.h"

namespace ft::inline collision {

class NodePatches {
 public:
  bool built() const { return !of_node_.empty(); }

  /// of_element(element): its patches, ascending.
  template <class OfElement>
  void build(std::span<const PairNode> nodes, std::size_t element_count, OfElement&& of_element) {
    start_.assign(1, 0);
    items_.clear();
    std::vector<int> known(1024, -1);  // sets by hash: a map's keys would take several times what the sets do
    const auto place_of = [&](std::span<const int> set) {
      std::size_t k = hash_bytes(std::as_bytes(set)).low % known.size();
      while (known[k] >= 0 && !std::ranges::equal(items_of(known[k]), set)) k = (k + 1) % known.size();
      return k;
    };
    const auto number_of = [&](const std::vector<int>& set) {
      const std::size_t place = place_of(set);
      if (known[place] >= 0) return known[place];
      const int number = static_cast<int>(start_.size()) - 1;
      known[place] = number;
      items_.insert(items_.end(), set.begin(), set.end());
      start_.push_back(static_cast<int>(items_.size()));
      if (2 * start_.size() > known.size()) {
        known.assign(2 * known.size(), -1);
        for (int n = 0; n <= number; ++n) known[place_of(items_of(n))] = n;
      }
      return number;
    };
    std::vector<int> set;
    const auto common = [&](int a, int b) {
      if (a == b) return a;
      set.clear();
      std::set_intersection(&items_[0] + start_[at(a)], &items_[0] + start_[at(a) + 1], &items_[0] + start_[at(b)],
                            &items_[0] + start_[at(b) + 1], std::back_inserter(set));
      return number_of(set);
    };
    of_element_.resize(element_count);
    for (std::size_t e = 0; e < element_count; ++e) {
      const std::span<const int> own = of_element(e);
      set.assign(own.begin(), own.end());
      of_element_[e] = number_of(set);
    }
    of_node_.resize(nodes.size());
    for (std::size_t k = nodes.size(); k-- > 0;) {
      const PairNode& node = nodes[k];
      if (node.is_leaf()) {
        of_node_[k] = of_element_[at(node.first_element())];
        for (int e = node.first_element() + 1; e < node.end_element(); ++e)
          of_node_[k] = common(of_node_[k], of_element_[at(e)]);
      } else {
        const std::size_t child = at(node.first_child());
        of_node_[k] = common(of_node_[child], of_node_[child + 1]);
      }
    }
    start_.shrink_to_fit();
    items_.shrink_to_fit();
  }

  /// Whether everything below a node is in one of the skipped patches.
  bool any(int node, std::span<const char> skipped) const { return any_in(of_node_[at(node)], skipped); }
  /// Whether everything below two nodes is.
  bool any_common(int a, int b, std::span<const char> skipped) const {
    return any_in_both(of_node_[at(a)], of_node_[at(b)], skipped);
  }
  /// Whether two elements are.
  bool any_common_of_elements(int a, int b, std::span<const char> skipped) const {
    return any_in_both(of_element_[at(a)], of_element_[at(b)], skipped);
  }

 private:
  std::span<const int> items_of(int set) const {
    return {items_.data() + start_[at(set)], items_.data() + start_[at(set) + 1]};
  }
  bool any_in(int set, std::span<const char> skipped) const {
    for (int i = start_[at(set)]; i < start_[at(set) + 1]; ++i)
      if (skipped[at(items_[at(i)])] != 0) return true;
    return false;
  }
  bool any_in_both(int a, int b, std::span<const char> skipped) const {
    if (a == b) return any_in(a, skipped);
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

  std::vector<int> of_node_, of_element_;  ///< sets by number
  std::vector<int> start_, items_;         ///< of the sets
};

}  // namespace ft::inline collision

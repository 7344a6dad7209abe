// Sets of the numbers 0 to n - 1 that are joined two at a time. A set is named by its smallest number, so names do not
// depend on the order of joining. Path halving: Tarjan and van Leeuwen (1984), "Worst-case analysis of set union
// algorithms".
#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "baker/core/mesh.h"

namespace ft {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) { reset(count); }
  /// Every number is alone.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::size_t count() const { return parent_.size(); }
  /// The smallest number in the set of i.
  int root(int i) const {
    while (parent_[at(i)] != i) i = parent_[at(i)];
    return i;
  }
  /// Makes one of the sets of a and b, and returns its root.
  int join(int a, int b) {
    a = halve_path(a), b = halve_path(b);
    if (a > b) std::swap(a, b);
    return parent_[at(b)] = a;
  }
  /// The sets of more than one, a row each: by their smallest number, and ascending.
  Adjacency groups() const {
    std::vector<int> size(count(), 0), next(count(), -1);
    for (int i = 0; i < static_cast<int>(count()); ++i) ++size[at(root(i))];
    Adjacency out{{0}, {}};
    for (std::size_t i = 0; i < count(); ++i)
      if (size[i] > 1) next[i] = out.start.back(), out.start.push_back(next[i] + size[i]);
    out.items.resize(at(out.start.back()));
    for (int i = 0; i < static_cast<int>(count()); ++i)
      if (int& place = next[at(root(i))]; place >= 0) out.items[at(place++)] = i;
    return out;
  }

 private:
  int halve_path(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  std::vector<int> parent_;
};

}  // namespace ft

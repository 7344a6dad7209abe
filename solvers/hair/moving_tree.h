// A box tree over triangles at the start of a step that knows how far each of its nodes goes in it beside a common
// motion: so what a point can meet in the step is looked for no farther than that.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "baker/core/types.h"
#include "collision/geometry/triangle_tree.h"

namespace ft::inline solvers {

class MovingTree {
 public:
  MovingTree() = default;
  explicit MovingTree(TriangleTree tree) : tree_(std::move(tree)), ways_(tree_.nodes().size(), 0.0) {}

  bool empty() const { return tree_.empty(); }
  const TriangleTree& tree() const { return tree_; }
  void refit(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    if (!empty()) tree_.refit(positions, triangles);
  }
  /// vertex_ways: of each vertex, squared, beside the common motion [m2].
  void set_ways(std::span<const double> vertex_ways, std::span<const Triangle> triangles);

  /// Calls visit(triangle) for the triangles of leaves that are within `reach` and what they go of a box.
  template <class Visit>
  void for_each_within(const Vec3& lo, const Vec3& hi, double reach, Visit&& visit) const {
    if (!empty()) walk(0, lo, hi, reach, visit);
  }

 private:
  template <class Visit>
  void walk(int i, const Vec3& lo, const Vec3& hi, double reach, Visit& visit) const {
    const TriangleTree::Node& node = tree_.nodes()[at(i)];
    double squared = 0;
    for (int k = 0; k < 3; ++k) {
      const double off = std::max({node.box.lo[k] - hi[k], lo[k] - node.box.hi[k], 0.0});
      squared += off * off;
    }
    const double within = reach + ways_[at(i)];
    if (squared > within * within) return;
    if (node.count > 0) {
      for (int k = 0; k < node.count; ++k) visit(tree_.order()[at(node.first + k)]);
      return;
    }
    walk(i + 1, lo, hi, reach, visit);
    walk(node.first, lo, hi, reach, visit);
  }

  TriangleTree tree_;
  std::vector<double> ways_;  ///< of each node [m]
};

}  // namespace ft::inline solvers

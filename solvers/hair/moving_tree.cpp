#include "solvers/hair/moving_tree.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {

void MovingTree::set_ways(std::span<const double> vertex_ways, std::span<const Triangle> triangles) {
  // Children stand behind their parents.
  for (std::size_t i = ways_.size(); i-- > 0;) {
    const TriangleTree::Node& node = tree_.nodes()[i];
    double squared = 0;
    for (int k = 0; k < node.count; ++k)
      for (const int v : triangles[at(tree_.order()[at(node.first + k)])])
        squared = std::max(squared, vertex_ways[at(v)]);
    ways_[i] = node.count > 0 ? std::sqrt(squared) : std::max(ways_[i + 1], ways_[at(node.first)]);
  }
}

}  // namespace ft::inline solvers

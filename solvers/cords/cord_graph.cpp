#include "solvers/cords/cord_graph.h"

#include <algorithm>
#include <numeric>

#include "baker/core/check.h"

namespace ft::inline solvers {

void add_side(CordGraph& graph, int a, int b, int pieces) {
  CHECK(pieces >= 1);
  const Vec3 start = graph.points[at(a)], way = graph.points[at(b)] - start;
  int last = a;
  for (int i = 1; i <= pieces; ++i) {
    const int next = i == pieces ? b : static_cast<int>(graph.points.size());
    if (i < pieces) graph.points.push_back(start + way * (static_cast<double>(i) / pieces));
    graph.cords.push_back({std::min(last, next), std::max(last, next)});
    last = next;
  }
}

std::vector<double> lumped_masses(const CordGraph& graph, double total) {
  std::vector<double> out(graph.points.size(), 0.0);
  double length = 0;
  for (const Edge& cord : graph.cords) {
    const double own = (graph.points[at(cord[1])] - graph.points[at(cord[0])]).norm();
    for (const int end : cord) out[at(end)] += 0.5 * own;
    length += own;
  }
  CHECK(length > 0);
  const double heavier = std::accumulate(graph.heavier.begin(), graph.heavier.end(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = total * (out[i] / length + (graph.heavier.empty() ? 0 : graph.heavier[i])) / (1 + heavier);
  return out;
}

}  // namespace ft::inline solvers

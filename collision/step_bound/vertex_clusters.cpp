#include "collision/step_bound/vertex_clusters.h"

#include <algorithm>
#include <functional>

#include "baker/core/check.h"
#include "baker/core/disjoint_sets.h"

namespace ft::inline collision {

VertexClusters::VertexClusters(const RestEdges& edges, std::span<const double> size) {
  std::vector<std::size_t> shortest;
  for (std::size_t k = 0; k < edges.edges.size(); ++k) {
    const auto [a, b] = edges.edges[k];
    CHECK(at(a) < size.size() && at(b) < size.size());
    if (edges.lengths[k] <= std::min(size[at(a)], size[at(b)])) shortest.push_back(k);
  }
  if (shortest.empty()) return;
  std::stable_sort(shortest.begin(), shortest.end(),
                   [&](std::size_t a, std::size_t b) { return edges.lengths[a] < edges.lengths[b]; });
  DisjointSets sets(size.size());
  std::vector<double> way(size.size(), 0.0);  // per root: the longest in the set is no longer
  for (const std::size_t k : shortest) {
    const int a = sets.root(edges.edges[k][0]), b = sets.root(edges.edges[k][1]);
    if (a == b) continue;
    const double joined = way[at(a)] + edges.lengths[k] + way[at(b)];
    if (joined <= std::min(size[at(a)], size[at(b)])) way[at(sets.join(a, b))] = joined;
  }
  clusters_ = sets.groups();
  of_.assign(size.size(), -1);
  for (int c = 0; c < count(); ++c)
    for (const int v : members(c)) of_[at(v)] = c;
}

template <class Value, class Before>
void VertexClusters::take_first(std::span<Value> values, const Before& before) const {
  for (int c = 0; c < count(); ++c) {
    Value first = values[at(members(c)[0])];
    for (const int v : members(c))
      if (before(values[at(v)], first)) first = values[at(v)];
    for (const int v : members(c)) values[at(v)] = first;
  }
}

void VertexClusters::take_least(std::span<double> values) const {
  take_first(values, std::less<>());
}
void VertexClusters::take_most(std::span<double> values) const {
  take_first(values, std::greater<>());
}
void VertexClusters::take_most(std::span<char> values) const {
  take_first(values, std::greater<>());
}

Vec3 VertexClusters::mean(int cluster, std::span<const Vec3> values) const {
  Vec3 sum = Vec3::Zero();
  for (const int v : members(cluster)) sum += values[at(v)];
  return sum / static_cast<double>(members(cluster).size());
}

void VertexClusters::take_mean(std::span<Vec3> values) const {
  for (int c = 0; c < count(); ++c) {
    const Vec3 common = mean(c, values);
    for (const int v : members(c)) values[at(v)] = common;
  }
}

}  // namespace ft::inline collision

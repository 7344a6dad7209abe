// Vertices that lie so near each other at rest that they cannot part: pairs that a knife tool or a merge with too small
// a tolerance left behind, support loops along a hem. What a step is cut by is fractions of a millimetre; on an edge
// that is not much longer it would be strain. So they are cut alike: what one of a cluster may not do, none of it does.
#pragma once

#include <span>
#include <vector>

#include "baker/core/edge_strain.h"
#include "baker/core/mesh.h"

namespace ft::inline collision {

class VertexClusters {
 public:
  VertexClusters() = default;
  /// Joins vertices along the edges, the shortest first, as long as no way inside a cluster gets longer than `size` of
  /// its vertices [m], which has one entry per vertex.
  VertexClusters(const RestEdges& edges, std::span<const double> size);

  bool empty() const { return clusters_.items.empty(); }
  int count() const { return clusters_.row_count(); }
  /// The cluster of a vertex, -1: it is alone.
  int of(int vertex) const { return empty() || at(vertex) >= of_.size() ? -1 : of_[at(vertex)]; }
  /// At least two vertices, ascending.
  std::span<const int> members(int cluster) const { return clusters_.row(cluster); }
  /// The vertices of its cluster, or itself: the number has to live as long as what is returned.
  std::span<const int> with(const int& vertex) const {
    const int cluster = of(vertex);
    return cluster < 0 ? std::span<const int>(&vertex, 1) : members(cluster);
  }
  /// Of the values that the vertices of a cluster have.
  Vec3 mean(int cluster, std::span<const Vec3> values) const;
  /// Gives all vertices of a cluster the smallest, or the largest, of their values.
  void take_least(std::span<double> values) const;
  void take_most(std::span<double> values) const;
  void take_most(std::span<char> values) const;
  /// Gives all vertices of a cluster the mean of their values.
  void take_mean(std::span<Vec3> values) const;

 private:
  template <class Value, class Before>
  void take_first(std::span<Value> values, const Before& before) const;

  std::vector<int> of_;
  Adjacency clusters_{{0}, {}};
};

}  // namespace ft::inline collision

// Short edges while cloth is carried (carry_field.h, approach_limits.h). Behind the carry field is a mesh of about even
// edges, each vertex with pulls of its own. A dense spot among wide triangles is not that: its vertices are corners of
// triangles that reach far, each is pulled by other contacts, and the field differs between neighbours by many times
// their distance; so does what is moved out of a way beside what is not. No solve mends that. Therefore what has short
// edges is carried smoothly over the length of a typical edge:
//   min  sum_i |c_i - c_i0|^2 + sum_edges k (typical / length)^2 |c_i - c_j|^2
// and takes what is around it along when it is moved out of a way. Cloth without short edges is carried as it was.
#pragma once

#include <span>
#include <vector>

#include "baker/core/edge_strain.h"
#include "baker/core/types.h"
#include "collision/step_bound/vertex_clusters.h"

namespace ft::inline solvers {

class CarrySmooth {
 public:
  CarrySmooth() = default;
  /// Edges up to `short_edge` of the typical one, which has one entry per vertex [m], are short; what has one is linked
  /// along others that are not long. Vertices of a cluster are at one place for this.
  CarrySmooth(std::span<const Vec3> rest, const RestEdges& edges, std::span<const double> typical_edge,
              double short_edge, const VertexClusters& clusters);

  bool empty() const { return vertices_.empty(); }
  void smooth(std::span<Vec3> carry) const;

  struct Share {
    int vertex;
    double weight;  ///< above 0, up to 1
  };
  /// To be kept between calls.
  struct Walk {
    std::vector<Share> shares;
    std::vector<char> seen;
    std::vector<int> reached;
  };
  /// Who comes along, and by how much, when a vertex is moved: what is near it along links, its cluster all the way.
  /// Empty when it has none.
  std::span<const Share> along_with(int vertex, Walk& walk) const;

 private:
  struct Link {
    int a, b;       ///< into vertices_
    double weight;  ///< k (typical / length)^2
  };
  int number_of(int vertex) const;
  void multiply(std::span<const Vec3> x, std::span<Vec3> out) const;

  std::vector<int> vertices_;  ///< that are linked, ascending
  std::vector<Vec3> place_;    ///< of each at rest, of its cluster where it is in one [m]
  std::vector<double> reach_;  ///< of each: what is nearer comes along [m]
  std::vector<Link> links_;
  std::vector<double> diagonal_;
  std::vector<int> start_, next_;  ///< links of each: from start_ on into next_
};

}  // namespace ft::inline solvers

// Vertices that ride on a garment with fewer vertices: where they are, and what they cross. For riding_solver.cpp.
// All that were drawn into one vertex are a group.
//     x = that vertex + what was between, turned as the edges there have turned
// where no edge leads from the group to another: a spot of tiny triangles is carried as it is, and does not strain.
//     x = the point of a triangle that was nearest at rest + what was left, in the triangle's frame
// elsewhere. At rest both are exactly the given vertex. What is drawn in lies eight times nearer to its group's vertex,
// as in the first.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/edge_strain.h"
#include "collision/check/checked_surface.h"
#include "collision/check/crossings.h"
#include "collision/check/sewn_pairs.h"
#include "solvers/cloth/embed/coarse_garment.h"

namespace ft::inline solvers {

struct Riders {
  /// An edge of what moves, at the vertex that a group was drawn into.
  struct Spoke {
    int end = 0;
    Vec3 direction = Vec3::Zero();  ///< at rest [1]
  };
  std::string name;
  Mesh mesh;              ///< as given
  std::vector<int> kept;  ///< its vertex of each that moves
  std::vector<CoarsenedMesh::Place> places;
  std::vector<Vec3> offset;                ///< in the frame of the place's triangle [m]; unused where the vertex moves
  std::vector<int> group;                  ///< of each vertex, from 0; -1: it moves
  std::vector<int> into;                   ///< of each group: the moving vertex
  std::vector<std::vector<Spoke>> spokes;  ///< of each group
  std::vector<char> alone;                 ///< of each group: no edge leads to another
  std::vector<Vec3> around;                ///< per vertex at rest: from the one it was drawn into [m]
  std::size_t first_group = 0;

  std::size_t group_count() const { return into.size(); }
  /// Positions of all from those of what moves; drawn_in: per group, 0 or 1.
  void place(std::span<const Vec3> moved, std::span<const double> drawn_in, std::span<Vec3> out) const;
  /// From rest to where a group's spokes are now, by least squares.
  Mat3 turn_of(std::size_t in_group, std::span<const Vec3> moved) const;
};

struct RidingCrossings {
  std::vector<Crossing> with_body, own;  ///< vertices of all garments in one numbering, and of the collider
  bool empty() const { return with_body.empty() && own.empty(); }
};

/// Of all garments of a setup, those that have none included.
class AllRiders {
 public:
  /// `coarse`: null when all of its vertices move.
  void add(const ClothGarment& given, const CoarseGarment* coarse);
  /// When all are there.
  void finish();

  const Riders& garment(int index) const { return garments_[at(index)]; }
  int garment_of(int vertex) const;
  std::size_t first_vertex(int index) const { return first_vertex_[at(index)]; }
  std::size_t vertex_count() const { return first_vertex_.back(); }
  std::size_t group_count() const { return group_count_; }
  const RestEdges& rest_edges() const { return rest_edges_; }
  /// From the numbering of what moves to the given one.
  void to_given(Incident& incident) const;

  /// Those in which something that rides takes part.
  RidingCrossings crossings(std::span<const Vec3> x, const CheckedSurface& collider) const;
  RidingCrossings all_crossings(std::span<const Vec3> x, const CheckedSurface& collider) const;
  /// Marks the groups that take part.
  void draw_in(const RidingCrossings& crossings, std::vector<double>& drawn_in) const;

 private:
  bool rides(int vertex) const { return group_[at(vertex)] >= 0; }
  bool counts(const Crossing& own) const;

  std::vector<Riders> garments_;
  std::vector<char> self_collides_;  ///< per garment
  std::vector<std::size_t> first_vertex_{0};
  std::size_t group_count_ = 0;
  std::vector<Triangle> triangles_, riding_;  ///< all; those with a vertex that rides
  std::vector<int> group_;                    ///< of each vertex, in one numbering; -1: it moves
  RestEdges rest_edges_;
  std::vector<Stitch> stitches_;
  SewnPairs sewn_;
};

}  // namespace ft::inline solvers

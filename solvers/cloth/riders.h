// Vertices that ride on a garment with fewer vertices: where they are, and what they cross. For riding_solver.cpp.
//
//     x = the point of a triangle that was nearest at rest + what was left, in the triangle's frame
//
// so that at rest it is exactly the given vertex, and in flat cloth a point of it. All that were drawn into one vertex
// are a group; what is drawn in lies eight times nearer around that vertex, and turns as one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/edge_strain.h"
#include "collision/checked_surface.h"
#include "collision/crossings.h"
#include "collision/sewn_pairs.h"
#include "solvers/cloth/coarse_garment.h"

namespace ft {

struct Riders {
  std::string name;
  Mesh mesh;              ///< as given
  std::vector<int> kept;  ///< its vertex of each that moves
  std::vector<CoarsenedMesh::Place> places;
  std::vector<Vec3> offset;  ///< in the frame of the place's triangle [m]; unused where the vertex moves
  std::vector<int> group;    ///< of each vertex, from 0; -1: it moves
  std::vector<int> into;     ///< of each group: the moving vertex
  std::vector<std::array<int, 3>> turns_with;  ///< of each group: the triangle that says how it turns
  std::vector<Vec3> around;  ///< per vertex: from the one it was drawn into, in the frame of that triangle [m]
  std::size_t first_group = 0;

  std::size_t group_count() const { return into.size(); }
  /// Positions of all from those of what moves; drawn_in: per group, 0 or 1.
  void place(std::span<const Vec3> moved, std::span<const double> drawn_in, std::span<Vec3> out) const;
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

}  // namespace ft

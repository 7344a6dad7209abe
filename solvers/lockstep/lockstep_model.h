// What never changes of a lockstep system: all points of all cords and the prop's four nodes as one numbering of nodes,
// masses, elements and contact data. Positions that contact looks at are a second numbering: the points, then the
// vertices of the prop's surface.
#pragma once

#include <span>
#include <vector>

#include "baker/core/equimomental.h"
#include "baker/core/types.h"
#include "solvers/lockstep/cord_elements.h"
#include "solvers/lockstep/lockstep_solver.h"

namespace ft::inline solvers {

struct LockstepModel {
  LockstepSetup setup;
  std::vector<int> first_point;  ///< of each cord system; one more at the end
  std::vector<Vec3> start;       ///< of the points [m]
  std::vector<double> mass;      ///< per node [kg]
  CordElements elements;
  Equimomental frame;                               ///< of the prop
  std::vector<std::array<double, 4>> skin_weights;  ///< per surface vertex, of the prop's nodes
  std::vector<Triangle> cords;                      ///< as PairFinder takes them
  std::vector<Triangle> skin;                       ///< the prop's triangles in the second numbering
  std::vector<int> system_of;                       ///< per point
  std::vector<double> rest_length;                  ///< per cord, as `cords`
  double contact_stiffness = 0;                     ///< N/m

  int point_count() const { return first_point.back(); }
  int node_count() const { return static_cast<int>(mass.size()); }
  bool has_prop() const { return setup.prop.has_value(); }
  int place_count() const { return point_count() + static_cast<int>(skin_weights.size()); }
  const CordSystem& cords_of(int point) const { return setup.cords[at(system_of[at(point)])]; }

  /// Nodes -> the second numbering; linear, so it takes displacements as well.
  void spread(std::span<const Vec3> nodes, std::vector<Vec3>& places) const;
  /// Adds what a place in the second numbering is made of.
  void add_place(int place, double weight, NodeTerm& term) const;
};

Result<LockstepModel> build_lockstep_model(LockstepSetup setup);

}  // namespace ft::inline solvers

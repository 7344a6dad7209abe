// What follows from a prototype once: its mesh about its centre of mass, inertia, chords and panels; and from a leaf
// and its prototype, the plate that flies.
#pragma once

#include <vector>

#include "baker/core/output_shape.h"
#include "solvers/leaves/leaves_setup.h"

namespace ft::inline solvers {

/// At scale 1 and with one unit of mass per area.
struct LeafShape {
  std::vector<Vec3> positions;  ///< about the centre of mass [m]
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;
  double area = 0;  ///< of all triangles [m2]
  Vec3 inertia =
      Vec3::Zero();  ///< for 1 kg/m2 [kg m2]; products of inertia, 0 for leaves alike on both sides, are left out
  Vec3 half_chord = Vec3::Zero();
  double panel_arm = 0;
  double radius = 0;  ///< of the ball about the centre of mass that holds it [m]
};

LeafShape shape_of(const LeafPrototype& prototype);

/// What the caches know of the setup's leaves: ids, prototypes, their meshes.
SystemShape instances_of(const LeavesSetup& setup);

/// All leaves as one mesh, in turn, at the start.
Mesh mesh_of(const LeavesSetup& setup);

/// mass_factor: by which this leaf's mass differs from the prototype's [1].
PlateModel plate_of(const LeafPrototype& prototype, const LeafShape& shape, double scale, double mass_factor,
                    double air_density);

}  // namespace ft::inline solvers

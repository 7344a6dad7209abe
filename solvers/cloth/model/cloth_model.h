// What never changes of a cloth system: all garments of a setup as one numbering of vertices, their rest shape, masses,
// contact data and pins. Built once by build_cloth_model().
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "baker/core/edge_strain.h"
#include "baker/core/result.h"
#include "collision/check/sewn_pairs.h"
#include "collision/step_bound/vertex_clusters.h"
#include "solvers/cloth/model/absence.h"
#include "solvers/cloth/model/carry_smooth.h"
#include "solvers/cloth/model/cloth_setup.h"
#include "solvers/cloth/model/contact_potential.h"
#include "solvers/cloth/model/moving_collider.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/energy.h"

namespace ft::inline solvers {

class DrawBack;

/// A vertex held to a point of the drawn body's surface, with an offset that turns with the triangle.
struct PinPoint {
  int vertex = 0;
  Triangle triangle{-1, -1, -1};   ///< drawn body vertices; -1: held at a fixed place
  std::array<double, 3> weight{};  ///< barycentric
  Vec3 offset = Vec3::Zero();      ///< in the triangle's frame [m]; the place itself when triangle is -1 [m]
  double stiffness = 0;            ///< N/m
  double max_pull = 0;             ///< N
  HoldSpan hold{};                 ///< when
  bool to_world = false;           ///< at a fixed place although there is a body: the body does not feel it
};

/// What lies nearer than this share of its garment's typical edge moves together as far as truncation goes [1]. Where
/// one end of an edge is held back it is by fractions of a contact radius: edges of 1/40 of the others are strained by
/// that until the cloth blows up, those of 1/28 are not.
inline constexpr double k_very_near = 1.0 / 16;

struct ClothModel {
  ClothSetup setup;
  std::vector<int> first_vertex;  ///< of each garment; one more at the end
  std::vector<Vec3> start;        ///< placed at the start of the pre-roll [m]; a solver frees what is the rest shape
  std::vector<double> mass;       ///< lumped [kg]
  std::span<const Triangle> triangles;  ///< of all garments
  std::vector<Triangle> own_triangles;  ///< what triangles sees, unless it is one garment's mesh
  std::vector<Vec3> own_rest;           ///< what contact.rest sees, unless it is one garment's mesh [m]
  RestEdges rest_edges;
  std::vector<double> typical_edge;  ///< per garment: median of its edges at rest; infinite without any [m]
  VertexClusters clusters;           ///< vertices that are very near each other for their garment
  CarrySmooth carry_smooth;          ///< what has such short edges
  std::vector<char> self_collides;   ///< per vertex
  std::vector<char> unused;          ///< vertices of no face: carried along, never solved for
  ContactModel contact;
  SewnPairs sewn;                  ///< pairs that a seam holds together
  std::vector<double> sewn_until;  ///< per vertex: when its garment's seams are closed [s]; empty: nothing is sewn
  std::vector<PinPoint> pins;
  std::vector<std::unique_ptr<Energy>> energies;
  DrawBack* draw_back = nullptr;  ///< one of the energies; null without a collider
  BlockPattern pattern;
  std::unique_ptr<ClothTopology> topology;  ///< while the model is built; energies copy what they need
  std::vector<AttachPoint> attachments;
  std::vector<SeamPoint> seams;
  std::vector<FlippedCap> flipped_caps;
  std::unique_ptr<MovingCollider> collider;  ///< null: cloth alone
  std::vector<int> part_rank;                ///< of the collider's parts: 0 is the largest
  std::vector<int> body_of_vertex;           ///< of the collider's vertices: into setup.bodies; empty: it is one
  Absence absence;                           ///< of the collider, where there is one
  double start_depth = 0;                    ///< how deep the deepest vertex started inside the body [m]

  int vertex_count() const { return static_cast<int>(mass.size()); }
  /// What forces are told of: the primary, or each of several bodies in it.
  std::size_t body_count() const { return std::max<std::size_t>(setup.bodies.size(), 1); }
  int garment_of(int vertex) const { return contact.garment[static_cast<std::size_t>(vertex)]; }
};

Result<std::unique_ptr<ClothModel>> build_cloth_model(ClothSetup setup);

}  // namespace ft::inline solvers

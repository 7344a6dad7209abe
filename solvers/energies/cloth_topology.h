// The rest shape of a cloth system as the energies need it: triangles with material axes, hinges with rest angles,
// lumped masses. Several garments share one numbering; each piece has its own fabric. Never changes after it is built.
// Caution: uvs give only the direction of the yarns, and lengths are those of the rest positions, unless a piece is cut
// from its pattern. Material axis 1 is weft (pattern u), axis 2 is warp (pattern v).
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "baker/core/types.h"
#include "solvers/energies/fabric.h"
#include "solvers/energies/hold_span.h"

namespace ft::inline solvers {

/// What varies over a garment, one value per vertex of it; an empty list changes nothing. Between vertices values run
/// linearly: a triangle takes the mean of its corners.
struct VertexMaps {
  std::vector<double> stretch;        ///< factor of the fabric's stretch and shear stiffness [1]; above 0
  std::vector<double> bend;           ///< factor of the fabric's bending rigidity [1]; 0 folds freely
  std::vector<double> mass_per_area;  ///< kg/m2, instead of the fabric's
  std::vector<double> thickness;      ///< m, instead of the garment's; for contact
};

/// The maps by name, as users and messages call them.
struct NamedMap {
  std::string_view name;
  std::vector<double> VertexMaps::*values;
};
inline constexpr std::array<NamedMap, 4> k_vertex_maps = {{{"stretch", &VertexMaps::stretch},
                                                           {"bend", &VertexMaps::bend},
                                                           {"mass_per_area", &VertexMaps::mass_per_area},
                                                           {"thickness", &VertexMaps::thickness}}};

/// A garment: a range of vertices of one fabric.
struct ClothPiece {
  int first_vertex = 0;
  int vertex_count = 0;
  Fabric fabric;
  /// m per unit of the uvs, from which lengths, areas and masses come then; they lie flat and may be mirrored. 0: from
  /// the rest positions, which otherwise say only what is near what.
  double pattern_scale = 0;
  VertexMaps maps{};
};

/// Two triangles at a common edge: (v0, v1, v2) and (v1, v0, v3) in the orientation of the first.
struct Hinge {
  std::array<int, 4> vertex{};
  double rest_angle = 0;  ///< rad, -pi..pi, signed as hinge_angle() says
  double rest_area = 0;   ///< of both triangles [m2]
  std::array<int, 2> triangle{};
  int piece = 0;
};

/// Bending of one triangle: its curvature follows from the angles at its edges. U = bends.M.bends / 2, with bends =
/// angle - rest angle of each edge's hinge, signed by this triangle's orientation. Edge k is opposite to corner k.
struct BendElement {
  int triangle = 0;
  std::array<int, 3> hinge{-1, -1, -1};  ///< of each edge; -1: free edge
  std::array<int, 3> sign{1, 1, 1};      ///< -1: the hinge sees this triangle from behind
  Mat3 stiffness = Mat3::Zero();         ///< M [N m / rad2]; rows of free edges are zero
};

/// A vertex that is sewn to the point (1 - place) x[edge[0]] + place x[edge[1]]; see seams.h.
struct SeamPoint {
  int vertex = 0;
  std::array<int, 2> edge{};
  double place = 0;
  double start_gap = 0;                ///< distance at which the seam starts to close [m]
  double opens_at = 0, closed_at = 0;  ///< the gap shrinks to nothing between these times [s]
  double stiffness = 0;                ///< N/m
  double pull = 0, hold = 0;           ///< force limit while it closes, and afterwards [N]
};

/// A vertex that hangs on a point of a triangle by a cord; see attachments.h.
struct AttachPoint {
  int vertex = 0;
  Triangle triangle{};
  std::array<double, 3> weight{};  ///< barycentric
  double length = 0;               ///< of the cord [m]
  double stiffness = 0;            ///< N/m
  double max_pull = 0;             ///< force limit [N]
  HoldSpan hold{};                 ///< when
};

/// A cap of the mesh that is none here, see caps.h: its vertex, and the edge that is in no triangle any more.
struct FlippedCap {
  int vertex = 0;
  Edge base{};
  double base_length = 0;  ///< at rest [m]
};

struct TriangleOrder;

struct ClothTopology {
  int vertex_count = 0;
  std::vector<Vec3> rest;           ///< m
  std::vector<Triangle> triangles;  ///< those of the mesh, but for flipped caps
  std::vector<FlippedCap> flipped_caps;
  std::vector<int> triangle_piece;
  std::vector<double> rest_area;  ///< of each triangle [m2]; 0 where the triangle is degenerate and carries nothing
  /// Inverse of the 2x2 matrix of rest edges (x1 - x0, x2 - x0) in material axes, row by row [1/m]; zero when
  /// degenerate.
  std::vector<std::array<double, 4>> rest_inverse;
  std::vector<Hinge> hinges;
  std::vector<BendElement> bends;  ///< one per triangle that has a hinge and resists bending
  std::vector<double> mass;        ///< kg per vertex: a third of each triangle around it
  std::vector<ClothPiece> pieces;
  std::vector<SeamPoint> seams;                        ///< none unless something is sewn
  std::vector<AttachPoint> attachments;                ///< none unless something is buttoned
  mutable std::shared_ptr<const TriangleOrder> order;  ///< triangle_order()'s, once it was asked

  const Fabric& fabric_of_triangle(std::size_t t) const {
    return pieces[static_cast<std::size_t>(triangle_piece[t])].fabric;
  }
  /// Mean of a map of factors over a triangle [1], exactly the value of the corners where they agree; 1 without a map.
  double factor(std::size_t t, std::vector<double> VertexMaps::*map) const;
};

/// triangle_uvs: pattern coordinates of the three corners of each triangle, or empty. Without them (or where they are
/// degenerate) warp is the rest shape's vertical, projected into the triangle; in flat-lying triangles, world z.
/// Vertices of no piece get no mass; a triangle belongs to the piece of its first vertex.
ClothTopology make_cloth_topology(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                                  std::span<const ClothPiece> pieces,
                                  std::span<const std::array<Vec2, 3>> triangle_uvs = {});

/// Rest length of the edge opposite to `corner` of a triangle that carries something [m].
double rest_length(const ClothTopology& topology, std::size_t triangle, std::size_t corner);

/// Signed angle between the normals of (x0, x1, x2) and (x1, x0, x3), about x1 - x0 [rad]; 0 when flat or degenerate.
double hinge_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3);

}  // namespace ft::inline solvers

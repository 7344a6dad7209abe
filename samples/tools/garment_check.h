// Is a garment ready to wear: nothing of it inside the body or through it, nor through itself, its triangles well
// shaped? What is not is moved out where little is missing. For make_garments.
#pragma once

#include <span>
#include <string>

#include "baker/core/mesh.h"
#include "samples/tools/body_slices.h"

namespace ft::garments {

/// How a garment lies about a body.
struct Fit {
  int crossings = 0;      ///< edges of either through triangles of the other
  int own_crossings = 0;  ///< of the garment through itself
  int inside = 0;         ///< garment vertices in the body
  double depth = 0;       ///< of the deepest of those [m]
  double gap = 0;         ///< of the garment vertex that is nearest to the body without being inside [m]
  int worst = -1;         ///< a vertex: the deepest, else one at a crossing, else the nearest

  /// Nothing starts through anything.
  bool clear() const { return crossings == 0 && own_crossings == 0 && inside == 0; }
  /// "12 crossings with the body, 3 vertices up to 4.5 mm inside it"; empty when clear.
  std::string text() const;
};

/// Crossings are exact (collision/check/crossings.h), inside is by the generalized winding number
/// (collision/check/penetration.h).
Fit fit_of(std::span<const Vec3> garment, std::span<const Triangle> triangles, const Body& body);

/// Pushes vertices that are inside the body or nearer than `clearance` [m] out of it, and their neighbours along with
/// them, until the garment is clear or nothing is gained any more; a garment that is clear and nowhere nearer than
/// `least_gap` [m] stays as it is. Returns the fit that it leaves. Caution: what is deep in the body, such as a hem in
/// a hand, may leave it on either side.
Fit move_out(std::vector<Vec3>& garment, std::span<const Triangle> triangles, const Body& body, double clearance,
             double least_gap);

struct ShapeQuality {
  double shortest_edge = 0, median_edge = 0, longest_edge = 0;  ///< m
  double smallest_angle_deg = 0, angle_deg_p1 = 0;              ///< of all corners; the first percentile
};
ShapeQuality shape_quality(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace ft::garments

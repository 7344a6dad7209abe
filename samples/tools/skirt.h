// A skirt: rings of points from the waist down. The waist ring follows the body's cross-section, from there the cloth
// falls straight or outwards, never inwards, and keeps its clearance. Near-regular quads: ring heights share the
// meridian's length equally and the points of a ring share its circumference equally. For make_garments.
#pragma once

#include "baker/core/mesh.h"
#include "samples/tools/body_slices.h"

namespace ft::garments {

struct SkirtSettings {
  int rings = 40;            ///< points from waist to hem
  int segments = 100;        ///< points around
  double length = 0;         ///< m along the height; 0: to just above the knee
  double flare = 0.14;       ///< m, growth of the radius from waist to hem
  double clearance = 8e-3;   ///< m, waist ring to body
  bool within_arms = false;  ///< keeps the clearance to arms and hands that hang beside it, too: narrower there
};

/// Vertex (ring, segment) is ring * segments + segment; group "waist" holds the two uppermost rings.
Mesh make_skirt(const BodyShape& shape, const SkirtSettings& settings);

}  // namespace ft::garments

// A T-shirt: the surface at a fixed distance from the body, cut off at the hem, the neck and the sleeves. It hangs on
// the shoulders by itself. Made by naive surface nets (Gibson 1998) on a regular grid and then relaxed along that
// surface, so that the quads are near-regular. For make_garments.
#pragma once

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "samples/tools/body_slices.h"

namespace ft::garments {

struct TopSettings {
  double cell = 14e-3;      ///< m, edge length to aim at
  double distance = 14e-3;  ///< m, to the body
  double clearance = 8e-3;  ///< m, no vertex is nearer to the body
  double hem = 20e-3;       ///< m, hem above the waist; negative: below it
  double sleeve = 0.10;     ///< m, sleeve beyond the shoulder; 0: sleeveless
};

/// Group "shoulders": what lies on them. Needs the arms along x.
Result<Mesh> make_top(const Body& body, const BodyShape& shape, const TopSettings& settings);

}  // namespace ft::garments

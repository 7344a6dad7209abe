// Where the strands of a [hair.NAME] come from: a file of guides, or a region of the body from which they grow.
#pragma once

#include "baker/core/mesh.h"
#include "baker/core/trajectory.h"
#include "baker/systems/hair/hair_spec.h"
#include "solvers/hair/hair_setup.h"

namespace ft::inline baker {

struct HairSource {
  std::vector<HairStrand> strands;  ///< of those the ones that are solved
  std::vector<std::string> notes;
  Mesh ridden;                    ///< a hair mesh whose middle lines the strands are [m]; else empty
  std::vector<MeshRider> riders;  ///< of its vertices, by `strands`
};

/// On the scalp's bind pose; what grows lies outside of the garments among the bodies, too. Errors: of the file, of the
/// region.
Result<HairSource> hair_source(const HairSpec& spec, const Trajectory& scalp, std::span<const HairBody> bodies);

}  // namespace ft::inline baker

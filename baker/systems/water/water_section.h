// The section [water.NAME] of the shot file.
#pragma once

#include "baker/systems/water/water_spec.h"

namespace ft::inline baker {

const SecondarySection& water_section();

}  // namespace ft::inline baker

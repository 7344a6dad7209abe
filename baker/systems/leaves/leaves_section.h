#pragma once

#include "baker/systems/leaves/leaves_spec.h"

namespace ft::inline baker {

const SecondarySection& leaves_section();

}  // namespace ft::inline baker

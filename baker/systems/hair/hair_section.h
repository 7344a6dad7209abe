#pragma once

#include "baker/systems/hair/hair_spec.h"

namespace ft::inline baker {

const SecondarySection& hair_section();

}  // namespace ft::inline baker

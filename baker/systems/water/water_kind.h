// Water as a kind of secondary.
#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

const SystemKind* water_kind();

}  // namespace ft::inline baker

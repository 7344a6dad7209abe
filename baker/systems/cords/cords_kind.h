// `[cords.NAME]`: ropes and nets.
#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

const SystemKind* cords_kind();

}  // namespace ft::inline baker

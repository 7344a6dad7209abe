// `[cords.NAME]`: ropes and nets.
#pragma once

#include "baker/systems/system.h"

namespace ft {

const SystemKind* cords_kind();

}  // namespace ft

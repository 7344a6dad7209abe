// `[cloth.NAME]`: garments and other sheets.
#pragma once

#include "baker/systems/system.h"

namespace ft {

const SystemKind* cloth_kind();

}  // namespace ft

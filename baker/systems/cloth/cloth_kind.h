// `[cloth.NAME]`: garments and other sheets.
#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

const SystemKind* cloth_kind();

}  // namespace ft::inline baker

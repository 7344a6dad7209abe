// `[follow.NAME]`: joints and vertices of a primary that follow their animation with a spring's lag.
#pragma once

#include "baker/systems/system.h"

namespace ft {

const SystemKind* follow_kind();

}  // namespace ft

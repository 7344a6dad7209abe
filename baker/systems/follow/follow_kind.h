// `[follow.NAME]`: joints and vertices of a primary that follow their animation with a spring's lag.
#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

const SystemKind* follow_kind();

}  // namespace ft::inline baker

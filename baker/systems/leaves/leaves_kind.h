#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

const SystemKind* leaves_kind();

}  // namespace ft::inline baker

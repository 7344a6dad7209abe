#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

const SystemKind* hair_kind();

}  // namespace ft::inline baker

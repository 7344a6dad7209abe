// Keys of [cords.NAME].
#pragma once

#include "baker/systems/cords/cords_spec.h"
#include "io/shot/shot_keys.h"

namespace ft::inline baker {

std::span<const ShotKey<CordsSpec>> cords_keys();

}  // namespace ft::inline baker

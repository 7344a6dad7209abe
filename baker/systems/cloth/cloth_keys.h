// Keys of [cloth.NAME], of its pins and of its maps.
#pragma once

#include "baker/systems/cloth/cloth_spec.h"
#include "io/shot/shot_keys.h"

namespace ft::inline baker {

std::span<const ShotKey<ClothSpec>> cloth_keys();  ///< beside the fabric's keys
std::span<const ShotKey<PinSpec>> pin_keys();      ///< one table of pins; group, within, vertices, file choose
std::span<const ShotKey<MapSpec>> map_keys();      ///< one table of maps; from, file choose

}  // namespace ft::inline baker

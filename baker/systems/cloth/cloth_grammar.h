// Grammars of [cloth.NAME] beyond single values: pins and maps.
#pragma once

#include "baker/systems/cloth/cloth_spec.h"
#include "io/shot/key_reader.h"

namespace ft::inline baker {

void read_pins(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed& allowed,
               ClothSpec& cloth);
void read_single_pin(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed& allowed,
                     ClothSpec& cloth);
/// "0-199, 250" or [0, 1, "5-9"]; nothing is changed by a fault.
void read_pin_vertices(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed& allowed,
                       PinSpec& pin);
void read_maps(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed& allowed,
               ClothSpec& cloth);

std::string pins_text(const ClothSpec& cloth, const std::filesystem::path& folder);
std::string maps_text(const ClothSpec& cloth, const std::filesystem::path& folder);

}  // namespace ft::inline baker

// A clip whose nodes are moved by keys alone, for formats that know nothing else (glTF).
#pragma once

#include "io/import/character/character.h"

namespace ft::inline io {

/// The clip with a channel in place of each stack of transforms: keys where the stack's curves have some, and between
/// them where a straight line would be off by more than 2e-7 (radians, or of the length of a translation), but none
/// nearer than 1/480 s to another. Shear, which comes of scales that are inherited, is left out. Channels and shapes
/// stay as they are.
Clip plain_clip(const Character& character, const Clip& clip);

}  // namespace ft::inline io

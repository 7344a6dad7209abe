// A clip whose nodes are moved by keys alone, for formats that know nothing else (glTF).
#pragma once

#include "io/import/character/character.h"

namespace ft::inline io {

/// Times [s] at which a node that a stack moves needs keys so that straight lines follow it: where its curves have
/// keys, the clip's ends, and between them where a straight line would be off by more than 2e-7 (radians, or of the
/// length of a translation), but none nearer than 1/15360 s to another. Ascending.
std::vector<double> straight_times(const Character& character, const Clip& clip, int node);

/// The clip with a channel in place of each stack of transforms: cubic splines with keys where the stack's curves have
/// some, and between them where a spline would be off by more than 2e-7 (as above), but none nearer than 1/1920 s to
/// another. Shear, which comes of scales that are inherited, is left out with a note. Channels and shapes stay as they
/// are.
Clip plain_clip(const Character& character, const Clip& clip, std::vector<std::string>& notes);

}  // namespace ft::inline io

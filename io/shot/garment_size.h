// Doubts a garment of a size that none has: nearly always a slip of units. For `info`, and for the notes of a bake.
#pragma once

#include <string>

namespace ft::inline io {

/// Empty for what may be a garment: between 2 cm and 10 m in size. Else a sentence without its subject, with the
/// unit_scale that would make a garment of it, if a common unit does: "is 58 m in size, ...".
/// size: longest side of its box [m], as unit_scale [m per unit of the file] has made it.
std::string doubt_of_size(double size, double unit_scale);

}  // namespace ft::inline io

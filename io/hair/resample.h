// Lines at even distances.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

/// Of a polyline [m].
double length_of(std::span<const Vec3> line);

/// `vertices` points (at least 2) at equal distances along the line, ends kept exactly. Its length is that of the line
/// less what chords lose at corners. A line of one point gives that point again and again.
std::vector<Vec3> resampled(std::span<const Vec3> line, int vertices);

/// The first `length` of the line [m]; all of it where it is shorter. Ends exactly there.
std::vector<Vec3> cut_to(std::span<const Vec3> line, double length);

}  // namespace ft::inline io

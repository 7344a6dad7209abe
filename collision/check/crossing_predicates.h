// Exact signs for the certificate: orientation in the plane and the exact answer where the quick one of crossings.h
// does not decide. Error bounds and expansion arithmetic after Shewchuk 1997, "Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates". Exact for coordinates whose products neither overflow nor underflow
// (1e-70 to 1e70, and 0).
#pragma once

#include "baker/core/types.h"

namespace ft::inline collision {

/// Sign of the area of (a, b, c): positive when counter-clockwise. Exact.
int orientation_2d(const Vec2& a, const Vec2& b, const Vec2& c);

/// orientation() without the quick answer, for tests of the filter.
int orientation_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace ft::inline collision

// What is wrong with bodies that are to float in a rectangle of columns.
#pragma once

#include "solvers/water/water_body.h"

namespace ft::inline solvers {

/// Adds a fault for each that is no body, weighs nothing, is larger than the rectangle or beyond it, or overlaps
/// another. origin: its least x and z; wide, deep: along x and z [m].
void check_floats(std::span<const PlacedFloat> floats, const Vec2& origin, double wide, double deep,
                  std::vector<std::string>& faults);

}  // namespace ft::inline solvers

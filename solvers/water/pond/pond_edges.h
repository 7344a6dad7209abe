// What happens to the waves of a pond once a frame: an open edge takes those that reach its rim, wind feeds short ones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solvers/water/pond/pond_modes.h"

namespace ft::inline solvers {

/// Share of the surface and its potential that a rim keeps in a frame, on the grid; 1 inside. What it takes away is
/// growing towards the wall, so that long and short waves alike are taken before they come back.
std::vector<double> rim_keeps(const PondModes& modes, double width, double frame_time);

/// Returns the volume that left [m3].
double absorb_at_rim(const PondModes& modes, std::span<const double> keeps, std::span<double> eta,
                     std::span<double> potential);

/// A ruffle of waves shorter than a metre or so, as a wind of that velocity raises over a short fetch; each wave is
/// drawn towards a size of its own by random pushes, so that waves of other origin of the same lengths fade within a
/// minute. Pushes are of (seed, frame, wave). Standing waves: the ruffle knows the wind's axis, not its sense.
void ruffle(const PondModes& modes, double wind_x, double wind_z, std::uint64_t seed, int frame, double frame_time,
            std::span<double> potential);

}  // namespace ft::inline solvers

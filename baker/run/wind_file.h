// The air of a shot as the preview draws it: its velocity at places around what moves, every few frames.
#pragma once

#include <string>

#include "baker/plan/plan.h"

namespace ft::inline baker {

inline constexpr const char* k_wind_file = "wind.json";

/// {"every": frames between two samples, from the first written on; "reach": m, between neighbouring places;
/// "places": [[x, y, z]] in mm, "velocities": [[of each place x, y, z in cm/s]]}, one list for each sample; whole
/// numbers all.
std::string wind_samples(const BakePlan& plan);

}  // namespace ft::inline baker

// What is wrong with a rectangle of columns over a bed: more of them than memory, heights of another number, no water.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline solvers {

/// Setup: nx, nz, cell [m], level [m], bed and depth of cells [m], empty or one each, and memory_limit [bytes].
/// memory(nx, nz): bytes that so many cells need. Adds a fault for each.
template <class Setup, class Memory>
void check_columns(const Setup& s, Memory&& memory, std::vector<std::string>& faults) {
  const double bytes = s.nx > 0 && s.nz > 0 ? memory(s.nx, s.nz) : 0;
  if (bytes > s.memory_limit)
    faults.push_back(
        fmt::format("{} x {} cells need {:.0f} MB, more than the {:.0f} MB allowed: a cell of {:.3g} m would fit", s.nx,
                    s.nz, bytes / 1e6, s.memory_limit / 1e6, s.cell * std::sqrt(bytes / s.memory_limit)));
  const std::size_t cells = s.nx > 0 && s.nz > 0 ? at(s.nx) * at(s.nz) : 0;
  const auto finite = [](const std::vector<double>& v) {
    return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  };
  const bool bed_fits = s.bed.empty() || s.bed.size() == cells, depth_fits = s.depth.empty() || s.depth.size() == cells;
  if (!bed_fits) faults.push_back(fmt::format("the bed has {} heights for {} cells", s.bed.size(), cells));
  if (!depth_fits) faults.push_back(fmt::format("there are {} depths for {} cells", s.depth.size(), cells));
  if (!finite(s.bed) || !finite(s.depth) || !std::isfinite(s.level))
    faults.push_back("a height or a depth is not a number");
  if (std::any_of(s.depth.begin(), s.depth.end(), [](double d) { return d < 0; }))
    faults.push_back("a depth is below 0");
  if (bed_fits && depth_fits && cells > 0) {
    const double lowest = s.bed.empty() ? 0 : *std::min_element(s.bed.begin(), s.bed.end());
    const bool dry = s.depth.empty() ? lowest >= s.level
                                     : std::all_of(s.depth.begin(), s.depth.end(), [](double d) { return d == 0; });
    if (dry)
      faults.push_back(
          fmt::format("no water: the bed, {} m at its lowest, is nowhere below the surface at {} m", lowest, s.level));
  }
}

}  // namespace ft::inline solvers

// See paper_setup.h.
#include "solvers/water/paper/paper_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/water/float_checks.h"

namespace ft::inline solvers {
namespace {

/// Whole-domain arrays of doubles: depths, pipes, beds, heads and what a step needs.
constexpr double k_arrays = 16;

}  // namespace

double paper_memory(int nx, int nz) {
  return 8 * k_arrays * nx * nz;
}

Status check_paper_setup(const PaperSetup& s) {
  std::vector<std::string> faults;
  const auto fault = [&](std::string text) { faults.push_back(std::move(text)); };
  if (s.nx < 1 || s.nz < 1) fault(fmt::format("{} x {} cells: each must be 1 or more", s.nx, s.nz));
  if (!(s.cell > 0 && s.cell < 1e3)) fault(fmt::format("cells of {} m: must be above 0 and below 1000", s.cell));
  if (!(s.gravity > 0)) fault(fmt::format("gravity {} must be above 0", s.gravity));
  if (!(s.density > 0)) fault(fmt::format("density {} must be above 0", s.density));
  if (!(s.cfl > 0 && s.cfl <= 0.8)) fault(fmt::format("cfl {} is outside 0 to 0.8", s.cfl));
  if (!(s.stiffness >= 2 && s.stiffness <= 100)) fault(fmt::format("stiffness {} is outside 2 to 100", s.stiffness));
  if (!(s.manning >= 0) || !(s.viscosity >= 0)) fault("manning and viscosity must be 0 or more");
  if (!(s.driven_drag >= 0)) fault(fmt::format("drag {} must be 0 or more", s.driven_drag));
  const PaperSplash& p = s.splash;
  if (!(p.share >= 0 && p.share <= 1)) fault(fmt::format("splash share {} is outside 0 to 1", p.share));
  if (!(p.threshold > 0)) fault(fmt::format("splash threshold {} must be above 0", p.threshold));
  if (!(p.fastest >= p.threshold)) fault(fmt::format("droplets of {} m/s are slower than the threshold", p.fastest));
  if (!(p.spread >= 0 && p.spread < 1.5)) fault(fmt::format("splash spread {} is outside 0 to 1.5", p.spread));
  if (!(p.smallest >= 0 && p.largest >= p.smallest) || (p.smallest > 0) != (p.largest > 0))
    fault(fmt::format("droplets of {} to {} m: must be above 0 and in this order, or both 0", p.smallest, p.largest));
  const double bytes = s.nx > 0 && s.nz > 0 ? paper_memory(s.nx, s.nz) : 0;
  if (bytes > s.memory_limit)
    fault(fmt::format("{} x {} cells need {:.0f} MB, more than the {:.0f} MB allowed: a cell of {:.3g} m would fit",
                      s.nx, s.nz, bytes / 1e6, s.memory_limit / 1e6, s.cell * std::sqrt(bytes / s.memory_limit)));
  const std::size_t cells = s.nx > 0 && s.nz > 0 ? at(s.nx) * at(s.nz) : 0;
  const auto finite = [](const std::vector<double>& v) {
    return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  };
  const bool bed_fits = s.bed.empty() || s.bed.size() == cells, depth_fits = s.depth.empty() || s.depth.size() == cells;
  if (!bed_fits) fault(fmt::format("the bed has {} heights for {} cells", s.bed.size(), cells));
  if (!depth_fits) fault(fmt::format("there are {} depths for {} cells", s.depth.size(), cells));
  if (!finite(s.bed) || !finite(s.depth) || !std::isfinite(s.level)) fault("a height or a depth is not a number");
  if (std::any_of(s.depth.begin(), s.depth.end(), [](double d) { return d < 0; })) fault("a depth is below 0");
  if (bed_fits && depth_fits && cells > 0) {
    const double lowest = s.bed.empty() ? 0 : *std::min_element(s.bed.begin(), s.bed.end());
    const bool dry = s.depth.empty() ? lowest >= s.level
                                     : std::all_of(s.depth.begin(), s.depth.end(), [](double d) { return d == 0; });
    if (dry)
      fault(
          fmt::format("no water: the bed, {} m at its lowest, is nowhere below the surface at {} m", lowest, s.level));
  }
  check_floats(s.floats, s.origin, s.cell * s.nx, s.cell * s.nz, faults);
  if (faults.empty()) return {};
  std::string all;
  for (const std::string& f : faults) all += (all.empty() ? "" : "; ") + f;
  return usage_error(fmt::format("water \"{}\": {}", s.name, all));
}

}  // namespace ft::inline solvers

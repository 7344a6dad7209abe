// See paper_setup.h.
#include "solvers/water/paper/paper_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/water/column_checks.h"
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
  check_columns(s, paper_memory, faults);
  check_floats(s.floats, s.origin, s.cell * s.nx, s.cell * s.nz, faults);
  if (faults.empty()) return {};
  std::string all;
  for (const std::string& f : faults) all += (all.empty() ? "" : "; ") + f;
  return usage_error(all);
}

}  // namespace ft::inline solvers

// See shallow_setup.h.
#include "solvers/water/shallow/shallow_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/water/column_checks.h"
#include "solvers/water/float_checks.h"

namespace ft::inline solvers {
namespace {

/// Whole-domain arrays of doubles: the flow's, what is kept of wet ground, and a patch as large as the domain.
constexpr double k_arrays = 2 * 13 + 1;
}  // namespace

double shallow_memory(int nx, int nz) {
  return 8 * k_arrays * (nx + 5.0) * (nz + 5.0);
}

Status check_shallow_setup(const ShallowSetup& s) {
  std::vector<std::string> faults;
  const auto fault = [&](std::string text) { faults.push_back(std::move(text)); };
  if (s.nx < 1 || s.nz < 1) fault(fmt::format("{} x {} cells: each must be 1 or more", s.nx, s.nz));
  if (!(s.cell > 0 && s.cell < 1e3)) fault(fmt::format("cells of {} m: must be above 0 and below 1000", s.cell));
  if (!(s.gravity > 0)) fault(fmt::format("gravity {} must be above 0", s.gravity));
  if (!(s.density > 0)) fault(fmt::format("density {} must be above 0", s.density));
  if (!(s.cfl > 0 && s.cfl <= 0.33)) fault(fmt::format("cfl {} is outside 0 to 0.33", s.cfl));
  if (!(s.manning >= 0) || !(s.viscosity >= 0)) fault("manning and viscosity must be 0 or more");
  if (!(s.contact_pressure > 0)) fault(fmt::format("contact pressure {} must be above 0", s.contact_pressure));
  if (!(s.drying_time > 0)) fault(fmt::format("drying time {} must be above 0", s.drying_time));
  const ShallowSplash& p = s.splash;
  if (!(p.share >= 0 && p.share <= 1)) fault(fmt::format("splash share {} is outside 0 to 1", p.share));
  if (!(p.threshold > 0)) fault(fmt::format("splash threshold {} must be above 0", p.threshold));
  if (!(p.smallest > 0 && p.largest >= p.smallest))
    fault(fmt::format("droplets of {} to {} m: must be above 0, and in this order", p.smallest, p.largest));
  check_columns(s, shallow_memory, faults);
  check_floats(s.floats, s.origin, s.cell * s.nx, s.cell * s.nz, faults);
  if (faults.empty()) return {};
  std::string all;
  for (const std::string& f : faults) all += (all.empty() ? "" : "; ") + f;
  return usage_error(all);
}

}  // namespace ft::inline solvers

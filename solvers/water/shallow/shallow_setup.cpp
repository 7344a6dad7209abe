// See shallow_setup.h.
#include "solvers/water/shallow/shallow_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/water/body_columns.h"

namespace ft::inline solvers {
namespace {

/// Whole-domain arrays of doubles: the flow's, what is kept of wet ground, and a patch as large as the domain.
constexpr double k_arrays = 2 * 13 + 1;
/// Columns in which two bodies are compared, along each side of where their boxes meet.
constexpr int k_overlap_cells = 24;

bool overlap(const std::vector<Vec3>& a, const std::vector<Triangle>& a_triangles, const std::vector<Vec3>& b,
             const std::vector<Triangle>& b_triangles) {
  const Box box_a = bounds(a), box_b = bounds(b);
  if (!box_a.overlaps(box_b)) return false;
  const Vec3 lo = box_a.lo.cwiseMax(box_b.lo), hi = box_a.hi.cwiseMin(box_b.hi);
  const double size = std::max(hi.x() - lo.x(), hi.z() - lo.z());
  if (!(size > 0)) return false;
  const ColumnGrid grid{lo.x(), lo.z(), size / k_overlap_cells, k_overlap_cells, k_overlap_cells};
  BodyColumns in_a, in_b;
  const BodySurface surface_a{a_triangles, a}, surface_b{b_triangles, b};
  const double ceiling = std::max(box_a.hi.y(), box_b.hi.y()) + 1;
  in_a.find(grid, {&surface_a, 1}, ceiling);
  in_b.find(grid, {&surface_b, 1}, ceiling);
  for (std::size_t c = 0; c + 1 < in_a.start.size(); ++c)
    for (int s = in_a.start[c]; s < in_a.start[c + 1]; ++s)
      for (int t = in_b.start[c]; t < in_b.start[c + 1]; ++t) {
        const ColumnSpan &p = in_a.spans[at(s)], &q = in_b.spans[at(t)];
        if (p.column == q.column && p.bottom < q.top && q.bottom < p.top) return true;
      }
  return false;
}

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
  const double bytes = s.nx > 0 && s.nz > 0 ? shallow_memory(s.nx, s.nz) : 0;
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
  std::vector<std::vector<Vec3>> placed;
  for (const ShallowFloat& f : s.floats) {
    std::vector<Vec3> x;
    for (const Vec3& v : f.body.positions) x.push_back(f.start.pose * v);
    placed.push_back(x);
    const std::string& name = f.body.name;
    bool indices = !f.body.triangles.empty();
    for (const Triangle& t : f.body.triangles)
      for (const int v : t) indices = indices && v >= 0 && at(v) < x.size();
    if (!indices || !all_finite(x)) {
      fault(fmt::format("\"{}\" has no triangles, or names a vertex that is not there", name));
      placed.back().clear();
      continue;
    }
    if (!(f.body.mass.mass > 0)) fault(fmt::format("\"{}\" weighs {} kg: must be above 0", name, f.body.mass.mass));
    const Box box = bounds(x);
    const double wide = s.cell * s.nx, deep = s.cell * s.nz, slack = 1e-9 * (wide + deep);
    if (box.size().x() > wide + slack || box.size().z() > deep + slack)
      fault(fmt::format("\"{}\" is {:.3g} x {:.3g} m, larger than the domain of {:.3g} x {:.3g} m", name,
                        box.size().x(), box.size().z(), wide, deep));
    else if (box.lo.x() < s.origin.x() - slack || box.lo.z() < s.origin.y() - slack ||
             box.hi.x() > s.origin.x() + wide + slack || box.hi.z() > s.origin.y() + deep + slack)
      fault(fmt::format("\"{}\" starts beyond the domain's edge", name));
  }
  for (std::size_t a = 0; a < placed.size(); ++a)
    for (std::size_t b = a + 1; b < placed.size(); ++b)
      if (!placed[a].empty() && !placed[b].empty() &&
          overlap(placed[a], s.floats[a].body.triangles, placed[b], s.floats[b].body.triangles))
        fault(fmt::format("\"{}\" and \"{}\" overlap at the start", s.floats[a].body.name, s.floats[b].body.name));
  if (faults.empty()) return {};
  std::string all;
  for (const std::string& f : faults) all += (all.empty() ? "" : "; ") + f;
  return usage_error(fmt::format("water \"{}\": {}", s.name, all));
}

}  // namespace ft::inline solvers

#include "solvers/water/float_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "solvers/water/body_columns.h"

namespace ft::inline solvers {
namespace {

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

void check_floats(std::span<const PlacedFloat> floats, const Vec2& origin, double wide, double deep,
                  std::vector<std::string>& faults) {
  const auto fault = [&](std::string text) { faults.push_back(std::move(text)); };
  std::vector<std::vector<Vec3>> placed;
  for (const PlacedFloat& f : floats) {
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
    const double slack = 1e-9 * (wide + deep);
    if (box.size().x() > wide + slack || box.size().z() > deep + slack)
      fault(fmt::format("\"{}\" is {:.3g} x {:.3g} m, larger than the domain of {:.3g} x {:.3g} m", name,
                        box.size().x(), box.size().z(), wide, deep));
    else if (box.lo.x() < origin.x() - slack || box.lo.z() < origin.y() - slack ||
             box.hi.x() > origin.x() + wide + slack || box.hi.z() > origin.y() + deep + slack)
      fault(fmt::format("\"{}\" starts beyond the domain's edge", name));
  }
  for (std::size_t a = 0; a < placed.size(); ++a)
    for (std::size_t b = a + 1; b < placed.size(); ++b)
      if (!placed[a].empty() && !placed[b].empty() &&
          overlap(placed[a], floats[a].body.triangles, placed[b], floats[b].body.triangles))
        fault(fmt::format("\"{}\" and \"{}\" overlap at the start", floats[a].body.name, floats[b].body.name));
}

}  // namespace ft::inline solvers

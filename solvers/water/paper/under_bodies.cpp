// See under_bodies.h.
#include "solvers/water/paper/under_bodies.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// Thinner water is none [m].
constexpr double k_wet = 1e-6;

bool meet(const UnderBodies::Rectangle& a, const UnderBodies::Rectangle& b) {
  return a.i0 < b.i1 && b.i0 < a.i1 && a.k0 < b.k1 && b.k0 < a.k1;
}

double above(double head, double height) {
  return head > height ? head - height : 0;
}

}  // namespace

void UnderBodies::find(const ColumnsMet& water, std::span<const BodySurface> bodies, double ceiling, double stiffness) {
  water_ = water;
  softness_ = 1 / stiffness;
  const std::size_t count = at(water.nx) * at(water.nz);
  if (of_.size() != count) of_.assign(count, -1);
  for (const Cell& cell : cells_) of_[cell.c] = -1;
  cells_.clear();
  spans_.clear();
  boxes_.assign(bodies.size(), {});
  // Groups of bodies whose rectangles of cells meet.
  struct Group {
    Rectangle box;
    std::vector<int> bodies;
  };
  std::vector<Group> groups;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Box box;
    for (const Triangle& t : bodies[b].triangles)
      for (const int v : t) box.include(bodies[b].positions[at(v)]);
    if (bodies[b].triangles.empty() || !(box.lo.y() < ceiling)) continue;
    const auto cell = [&](double x, double origin, double up, int most) {
      return static_cast<int>(std::clamp(std::floor((x - origin) / water.cell) + up, 0.0, static_cast<double>(most)));
    };
    Rectangle& r = boxes_[b];
    r = {cell(box.lo.x(), water.origin.x(), 0, water.nx), cell(box.lo.z(), water.origin.y(), 0, water.nz),
         cell(box.hi.x(), water.origin.x(), 1, water.nx), cell(box.hi.z(), water.origin.y(), 1, water.nz)};
    if (r.empty()) continue;
    Group own{r, {static_cast<int>(b)}};
    for (bool grew = true; grew;) {
      grew = false;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        if (!meet(groups[g].box, own.box)) continue;
        const Rectangle& o = groups[g].box;
        own.box = {std::min(o.i0, own.box.i0), std::min(o.k0, own.box.k0), std::max(o.i1, own.box.i1),
                   std::max(o.k1, own.box.k1)};
        own.bodies.insert(own.bodies.end(), groups[g].bodies.begin(), groups[g].bodies.end());
        groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(g));
        grew = true;
        break;
      }
    }
    std::sort(own.bodies.begin(), own.bodies.end());
    groups.push_back(std::move(own));
  }
  std::vector<BodySurface> members;
  for (const Group& group : groups) {
    members.clear();
    for (const int b : group.bodies) members.push_back(bodies[at(b)]);
    const int ni = group.box.i1 - group.box.i0, nk = group.box.k1 - group.box.k0;
    columns_.find({water.origin.x() + water.cell * group.box.i0, water.origin.y() + water.cell * group.box.k0,
                   water.cell, ni, nk},
                  members, ceiling);
    for (int k = 0; k < nk; ++k)
      for (int i = 0; i < ni; ++i) {
        const std::size_t from = at(i) + at(ni) * at(k), c = at(group.box.i0 + i) + at(water.nx) * at(group.box.k0 + k);
        const int begin = static_cast<int>(spans_.size());
        for (int n = columns_.start[from]; n < columns_.start[from + 1]; ++n) {
          ColumnSpan span = columns_.spans[at(n)];
          span.bottom = std::max(span.bottom, water.bed[c]);
          if (!(span.top > span.bottom)) continue;
          span.bottom_body = static_cast<short>(group.bodies[at(span.bottom_body)]);
          span.top_body = static_cast<short>(group.bodies[at(span.top_body)]);
          spans_.push_back(span);
        }
        if (static_cast<int>(spans_.size()) == begin) continue;
        of_[c] = static_cast<int>(cells_.size());
        cells_.push_back({c, begin, static_cast<int>(spans_.size())});
      }
  }
}

double UnderBodies::holds(int cell, double head, bool soft) const {
  const Cell& own = cells_[at(cell)];
  double taken = 0;
  for (int n = own.begin; n < own.end; ++n) taken += above(head, spans_[at(n)].bottom) - above(head, spans_[at(n)].top);
  return head - water_.bed[own.c] - (soft ? 1 - softness_ : 1) * taken / k_columns_a_cell;
}

double UnderBodies::head_of(int cell, double depth) {
  const Cell& own = cells_[at(cell)];
  const double step = (1 - softness_) / k_columns_a_cell;
  turns_.clear();
  for (int n = own.begin; n < own.end; ++n) {
    turns_.emplace_back(spans_[at(n)].bottom, -step);
    if (std::isfinite(spans_[at(n)].top)) turns_.emplace_back(spans_[at(n)].top, step);
  }
  std::sort(turns_.begin(), turns_.end());
  double height = water_.bed[own.c], held = 0, slope = 1;
  for (const auto& [turn, change] : turns_) {
    const double next = held + slope * (turn - height);
    if (next >= depth) break;
    held = next, height = turn;
    slope += change;
  }
  return height + (depth - held) / slope;
}

bool UnderBodies::covered(int cell, double head) const {
  const Cell& own = cells_[at(cell)];
  int count = 0, last = -1;
  for (int n = own.begin; n < own.end; ++n) {
    const ColumnSpan& span = spans_[at(n)];
    if (!(span.bottom < head && head <= span.top) || span.column == last) continue;
    last = span.column;
    ++count;
  }
  return count == k_columns_a_cell;
}

double UnderBodies::work(int cell, double head) const {
  const Cell& own = cells_[at(cell)];
  const double open = head - water_.bed[own.c];
  double taken = 0;
  for (int n = own.begin; n < own.end; ++n) {
    const double b = above(head, spans_[at(n)].bottom), t = above(head, spans_[at(n)].top);
    taken += 0.5 * (b * b - t * t);
  }
  return head * holds(cell, head, true) - 0.5 * open * open + (1 - softness_) * taken / k_columns_a_cell;
}

void UnderBodies::forces(std::span<const double> head, double weight, const double* level, int only,
                         std::span<Wrench> out) const {
  const double area = water_.cell * water_.cell / k_columns_a_cell;
  for (const Cell& cell : cells_) {
    const int i = static_cast<int>(cell.c % at(water_.nx)), k = static_cast<int>(cell.c / at(water_.nx));
    if (only >= 0) {
      const Rectangle& r = boxes_[at(only)];
      if (i < r.i0 || k < r.k0 || i >= r.i1 || k >= r.k1) continue;
    }
    if (!(water_.depth[cell.c] > 0)) continue;
    const double h = level ? *level : head[cell.c];
    for (int n = cell.begin; n < cell.end; ++n) {
      const ColumnSpan& s = spans_[at(n)];
      const double x = water_.origin.x() + water_.cell * (i + (s.column % k_columns + 0.5) / k_columns);
      const double z = water_.origin.y() + water_.cell * (k + (s.column / k_columns + 0.5) / k_columns);
      const auto push = [&](double height, const Vec3& way, int body, double sign) {
        if (h > height && (only < 0 || only == body))
          out[at(body)].add(Vec3(x, height, z), sign * weight * area * (h - height) * way);
      };
      push(s.bottom, Vec3(s.bottom_x, 1, s.bottom_z), s.bottom_body, 1);
      if (std::isfinite(s.top)) push(s.top, Vec3(s.top_x, 1, s.top_z), s.top_body, -1);
    }
  }
}

bool UnderBodies::level_around(int body, std::span<const double> head, double& level) const {
  const Rectangle& r = boxes_[at(body)];
  if (r.empty()) return false;
  double free = 0, all = 0;
  int free_count = 0, count = 0;
  for (int k = std::max(0, r.k0 - 1); k < std::min(water_.nz, r.k1 + 1); ++k)
    for (int i = std::max(0, r.i0 - 1); i < std::min(water_.nx, r.i1 + 1); ++i) {
      const std::size_t c = at(i) + at(water_.nx) * at(k);
      if (!(water_.depth[c] > k_wet)) continue;
      all += head[c], ++count;
      if (of_[c] < 0) free += head[c], ++free_count;
    }
  if (count == 0) return false;
  level = free_count > 0 ? free / free_count : all / count;
  return true;
}

}  // namespace ft::inline solvers

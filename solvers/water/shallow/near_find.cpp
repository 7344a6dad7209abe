// Which cells are near, and what of the bodies counts there. See near_water.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/water/shallow/near_water.h"

namespace ft::inline solvers {
namespace {

constexpr double k_infinite = std::numeric_limits<double>::infinity();

}  // namespace

void NearWater::find(const Flow& flow, std::span<const NearBody> bodies, double world_x, double world_z,
                     const NearLaws& laws) {
  cells_.clear();
  ni_ = nk_ = 0;
  const double top = highest_water(flow) + flow.cell;
  Box box;
  std::vector<BodySurface> surfaces;
  for (const NearBody& b : bodies) {
    surfaces.push_back(b.surface);
    for (const Triangle& t : b.surface.triangles) {
      const Vec3* p[3] = {&b.surface.positions[at(t[0])], &b.surface.positions[at(t[1])],
                          &b.surface.positions[at(t[2])]};
      if (std::min({p[0]->y(), p[1]->y(), p[2]->y()}) < top)
        for (const Vec3* v : p) box.include(*v);
    }
  }
  if (box.empty()) return;
  const auto cell_of = [&](double value, double origin, int count) {
    return static_cast<int>(std::floor(std::clamp((value - origin) / flow.cell, -4.0, count + 4.0)));
  };
  i0_ = std::max(0, cell_of(box.lo.x(), world_x, flow.nx) - 2);
  k0_ = std::max(0, cell_of(box.lo.z(), world_z, flow.nz) - 2);
  ni_ = std::max(0, std::min(flow.nx, cell_of(box.hi.x(), world_x, flow.nx) + 3) - i0_);
  nk_ = std::max(0, std::min(flow.nz, cell_of(box.hi.z(), world_z, flow.nz) + 3) - k0_);
  if (ni_ == 0 || nk_ == 0) {
    ni_ = nk_ = 0;
    return;
  }
  grid_ = {world_x + flow.cell * i0_, world_z + flow.cell * k0_, flow.cell, ni_, nk_};
  columns_.find(grid_, surfaces, top);

  const std::size_t count = at(ni_) * at(nk_);
  near_.assign(count, 0);
  for (int k = 0; k < nk_; ++k)
    for (int i = 0; i < ni_; ++i) {
      const std::size_t n = at(i) + at(ni_) * at(k);
      if (columns_.start[n] == columns_.start[n + 1]) continue;
      double level = -k_infinite;
      for (int dk = -1; dk <= 1; ++dk)
        for (int di = -1; di <= 1; ++di) {
          const int a = std::clamp(i0_ + i + di, 0, flow.nx - 1), b = std::clamp(k0_ + k + dk, 0, flow.nz - 1);
          const std::size_t c = flow.of(a, b);
          level = std::max(level, flow.bed[c] + flow.h[c]);
        }
      for (int s = columns_.start[n]; s < columns_.start[n + 1]; ++s)
        if (columns_.spans[at(s)].bottom < level + flow.cell) near_[n] = 2;
    }
  index_.assign(count, -1);
  for (int k = 0; k < nk_; ++k)
    for (int i = 0; i < ni_; ++i) {
      const std::size_t n = at(i) + at(ni_) * at(k);
      bool near = near_[n] == 2;
      for (int dk = -1; dk <= 1 && !near; ++dk)
        for (int di = -1; di <= 1 && !near; ++di)
          if (i + di >= 0 && i + di < ni_ && k + dk >= 0 && k + dk < nk_)
            near = near_[at(i + di) + at(ni_) * at(k + dk)] == 2;
      if (!near) continue;
      index_[n] = static_cast<int>(cells_.size());
      Cell cell;
      cell.i = i0_ + i, cell.k = k0_ + k;
      cell.c = flow.of(cell.i, cell.k);
      cell.head0 = cell.head = flow.bed[cell.c] + flow.h[cell.c] + flow.lift[cell.c];
      if (near_[n] == 2) cell.spans_begin = columns_.start[n], cell.spans_end = columns_.start[n + 1];
      cells_.push_back(cell);
    }
  gate(flow, laws);
}

void NearWater::gate(const Flow& flow, const NearLaws& laws) {
  // Levels of water that may come over tops: of free cells, and of those that are overtopped all over, from cell to
  // cell until nothing changes.
  open_.assign(cells_.size(), -k_infinite);
  span_open_.assign(columns_.spans.size(), 0);
  for (std::size_t n = 0; n < cells_.size(); ++n)
    if (cells_[n].spans_begin == cells_[n].spans_end && flow.h[cells_[n].c] > k_dry) open_[n] = cells_[n].head0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t n = 0; n < cells_.size(); ++n) {
      const Cell& cell = cells_[n];
      if (cell.spans_begin == cell.spans_end || open_[n] > -k_infinite) continue;
      double level = -k_infinite;
      for (const int j :
           {index(cell.i - 1, cell.k), index(cell.i + 1, cell.k), index(cell.i, cell.k - 1), index(cell.i, cell.k + 1)})
        if (j >= 0) level = std::max(level, open_[at(j)]);
      bool all = true;
      for (int s = cell.spans_begin; s < cell.spans_end; ++s) {
        const bool open = columns_.spans[at(s)].top < level;
        if (open && span_open_[at(s)] == 0) span_open_[at(s)] = 1;
        all = all && open;
      }
      if (all) open_[n] = cell.head0, changed = true;
    }
  }
  reaches_.clear();
  const double step = flow.cell / k_columns;
  for (Cell& cell : cells_) {
    const double bed = flow.bed[cell.c];
    cell.begin = static_cast<int>(reaches_.size());
    double room = 0;
    cell.gives = k_infinite;
    int columns = 0, closed = -1, last = -1;
    for (int s = cell.spans_begin; s < cell.spans_end; ++s) {
      const ColumnSpan& span = columns_.spans[at(s)];
      if (span.column == closed || span.top <= bed) continue;
      const bool open = span_open_[at(s)] != 0;
      if (!open) closed = span.column;
      Reach r;
      const double x = grid_.x + flow.cell * (cell.i - i0_) + (span.column % k_columns + 0.5) * step;
      const double z = grid_.z + flow.cell * (cell.k - k0_) + (span.column / k_columns + 0.5) * step;
      r.bottom = std::max(span.bottom, bed);
      r.bottom_way = Vec3(span.bottom_x, 1, span.bottom_z);
      r.bottom_place = Vec3(x, r.bottom, z);
      r.bottom_body = span.bottom_body;
      r.top = open ? span.top : k_infinite;
      r.top_way = Vec3(span.top_x, 1, span.top_z);
      r.top_place = Vec3(x, span.top, z);
      r.top_body = span.top_body;
      if (r.bottom + laws.cap < r.top) {
        r.top = r.bottom + laws.cap;
        r.top_way = r.bottom_way, r.top_place = r.bottom_place, r.top_body = r.bottom_body;
      }
      cell.gives = std::min(cell.gives, r.top);
      reaches_.push_back(r);
      if (span.column != last) {
        last = span.column;
        if (open)
          room = k_infinite;
        else
          room += r.bottom - bed, ++columns;
      } else if (!open) {
        room = k_infinite;
      }
    }
    cell.end = static_cast<int>(reaches_.size());
    cell.capacity = columns == k_columns_a_cell ? room / k_columns_a_cell : k_infinite;
  }
}

double NearWater::holds(const Flow& flow, const Cell& cell, double head) const {
  double volume = head - flow.bed[cell.c];
  for (int s = cell.begin; s < cell.end; ++s) {
    const Reach& r = reaches_[at(s)];
    volume -= (std::max(0.0, head - r.bottom) - std::max(0.0, head - r.top)) / k_columns_a_cell;
  }
  return volume;
}

double NearWater::potential(const Flow& flow, const Cell& cell) const {
  const double bed = flow.bed[cell.c], head = cell.begin == cell.end ? bed + flow.h[cell.c] : cell.head;
  double sum = 0.5 * (head * head - bed * bed);
  for (int s = cell.begin; s < cell.end; ++s) {
    const Reach& r = reaches_[at(s)];
    if (head > r.bottom) sum -= 0.5 * (head * head - r.bottom * r.bottom) / k_columns_a_cell;
    if (head > r.top) sum += 0.5 * (head * head - r.top * r.top) / k_columns_a_cell;
  }
  return sum;
}

bool NearWater::level_around(std::size_t body, const Flow& flow, double& level) const {
  double sum = 0;
  int count = 0;
  for (const Cell& cell : cells_) {
    if (cell.begin != cell.end || flow.h[cell.c] <= k_dry) continue;
    bool beside = false;
    for (int dk = -1; dk <= 1; ++dk)
      for (int di = -1; di <= 1; ++di) {
        const int j = index(cell.i + di, cell.k + dk);
        if (j < 0) continue;
        const Cell& other = cells_[at(j)];
        for (int s = other.begin; s < other.end && !beside; ++s) beside = at(reaches_[at(s)].bottom_body) == body;
      }
    if (beside) sum += cell.head0, ++count;
  }
  if (count == 0) return false;
  level = sum / count;
  return true;
}

}  // namespace ft::inline solvers

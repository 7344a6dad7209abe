// See body_columns.h.
#include "solvers/water/body_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ft::inline solvers {
namespace {

/// Twice the signed area of edge a, b and p, the same number but for its sign from both of the edge's triangles.
double side_of(const Vec3& a, const Vec3& b, double x, double z) {
  const bool turned = b.x() < a.x() || (b.x() == a.x() && b.z() < a.z());
  const Vec3 &p = turned ? b : a, &q = turned ? a : b;
  const double area = (q.x() - p.x()) * (z - p.z()) - (q.z() - p.z()) * (x - p.x());
  return turned ? -area : area;
}

/// Whether a point on the edge from a to b belongs to the triangle on its left: to one of two that share it.
bool owns_edge(const Vec3& a, const Vec3& b) {
  return b.z() > a.z() || (b.z() == a.z() && b.x() < a.x());
}

void add_hits(const ColumnGrid& grid, const Vec3& a, const Vec3& b, const Vec3& c, short body,
              std::vector<BodyColumns::Hit>& hits) {
  const double area = (b.x() - a.x()) * (c.z() - a.z()) - (b.z() - a.z()) * (c.x() - a.x());
  if (area == 0 || !std::isfinite(area)) return;
  // Counter-clockwise in x, z faces down: a ray upwards enters.
  const Vec3 &p = a, &q = area > 0 ? b : c, &r = area > 0 ? c : b;
  const double step = grid.cell / k_columns;
  const int across = grid.nx * k_columns, along = grid.nz * k_columns;
  const auto first = [&](double lo, double origin) {
    return static_cast<int>(std::ceil(std::clamp((lo - origin) / step - 0.5, -1.0, 1e8)));
  };
  const auto last = [&](double hi, double origin, int count) {
    return std::min(count - 1, static_cast<int>(std::floor(std::clamp((hi - origin) / step - 0.5, -1.0, 1e8))));
  };
  const int i0 = std::max(0, first(std::min({a.x(), b.x(), c.x()}), grid.x)),
            i1 = last(std::max({a.x(), b.x(), c.x()}), grid.x, across);
  const int k0 = std::max(0, first(std::min({a.z(), b.z(), c.z()}), grid.z)),
            k1 = last(std::max({a.z(), b.z(), c.z()}), grid.z, along);
  if (i0 > i1 || k0 > k1) return;
  const bool own_pq = owns_edge(p, q), own_qr = owns_edge(q, r), own_rp = owns_edge(r, p);
  const double size = std::abs(area);
  const Vec3 n = (b - a).cross(c - a);
  const auto slope = [&](double part) { return static_cast<float>(std::clamp(part / n.y(), -k_steepest, k_steepest)); };
  const float slope_x = slope(n.x()), slope_z = slope(n.z());
  for (int k = k0; k <= k1; ++k)
    for (int i = i0; i <= i1; ++i) {
      const double x = grid.x + (i + 0.5) * step, z = grid.z + (k + 0.5) * step;
      const double w_r = side_of(p, q, x, z), w_p = side_of(q, r, x, z), w_q = side_of(r, p, x, z);
      if (w_r < 0 || w_p < 0 || w_q < 0) continue;
      if ((w_r == 0 && !own_pq) || (w_p == 0 && !own_qr) || (w_q == 0 && !own_rp)) continue;
      const double height = (w_p * p.y() + w_q * q.y() + w_r * r.y()) / size;
      const int cell = i / k_columns + grid.nx * (k / k_columns);
      hits.push_back({height, slope_x, slope_z, cell * k_columns_a_cell + k_columns * (k % k_columns) + i % k_columns,
                      body, static_cast<short>(area > 0 ? 1 : -1)});
    }
}

/// From the hits of one column, upwards.
void add_spans(std::span<const BodyColumns::Hit> hits, short column, double ceiling, std::vector<ColumnSpan>& spans) {
  int winding = 0;
  ColumnSpan span;
  for (const BodyColumns::Hit& hit : hits) {
    const int before = winding;
    if (before == 0 && hit.height > ceiling) break;
    winding = std::max(0, winding + hit.enters);
    if (before == 0 && winding > 0) {
      span = {hit.height, std::numeric_limits<double>::infinity(), hit.slope_x, hit.slope_z, 0, 0, hit.body, hit.body,
              column};
    } else if (before > 0 && winding == 0) {
      span.top = hit.height, span.top_x = hit.slope_x, span.top_z = hit.slope_z, span.top_body = hit.body;
      if (span.top > span.bottom) spans.push_back(span);
    }
  }
  if (winding > 0) spans.push_back(span);
}

}  // namespace

void BodyColumns::find(const ColumnGrid& grid, std::span<const BodySurface> bodies, double ceiling) {
  hits.clear();
  spans.clear();
  const std::size_t cells = at(grid.nx) * at(grid.nz);
  start.assign(cells + 1, 0);
  const double x1 = grid.x + grid.cell * grid.nx, z1 = grid.z + grid.cell * grid.nz;
  for (std::size_t n = 0; n < bodies.size(); ++n)
    for (const Triangle& t : bodies[n].triangles) {
      const Vec3 &a = bodies[n].positions[at(t[0])], &b = bodies[n].positions[at(t[1])],
                 &c = bodies[n].positions[at(t[2])];
      const Vec3 lo = a.cwiseMin(b).cwiseMin(c), hi = a.cwiseMax(b).cwiseMax(c);
      if (lo.y() > ceiling || hi.x() < grid.x || hi.z() < grid.z || lo.x() > x1 || lo.z() > z1) continue;
      add_hits(grid, a, b, c, static_cast<short>(n), hits);
    }
  // By column, then upwards; equal heights enter first, so that shells that touch are one.
  column_start.assign(cells * k_columns_a_cell + 1, 0);
  for (const Hit& hit : hits) ++column_start[at(hit.column) + 1];
  for (std::size_t c = 1; c < column_start.size(); ++c) column_start[c] += column_start[c - 1];
  sorted.resize(hits.size());
  for (const Hit& hit : hits) sorted[at(column_start[at(hit.column)]++)] = hit;
  int begin = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    start[cell] = static_cast<int>(spans.size());
    for (int column = 0; column < k_columns_a_cell; ++column) {
      const int end = column_start[cell * k_columns_a_cell + at(column)];
      if (end > begin) {
        std::sort(sorted.begin() + begin, sorted.begin() + end, [](const Hit& a, const Hit& b) {
          return std::tie(a.height, b.enters, a.body, a.slope_x, a.slope_z) <
                 std::tie(b.height, a.enters, b.body, b.slope_x, b.slope_z);
        });
        add_spans({sorted.data() + begin, sorted.data() + end}, static_cast<short>(column), ceiling, spans);
      }
      begin = end;
    }
  }
  start[cells] = static_cast<int>(spans.size());
}

}  // namespace ft::inline solvers

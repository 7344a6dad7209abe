#include "solvers/water/pond/skin_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/water/body_columns.h"

namespace ft::inline solvers {
namespace {

/// The part of a ray between two heights below the level, in pieces that grow with depth.
void add_column(double x, double z, double lo, double hi, double area, double least, SkinUnderWater& out) {
  double top = std::max(0.0, -hi);
  const double bottom = -lo;
  while (top < bottom) {
    double next = std::min(bottom, top + std::max(least, 0.3 * top));
    if (bottom - next < 0.3 * least) next = bottom;
    const double volume = area * (next - top);
    out.pieces.push_back({x, z, 0.5 * (top + next), volume});
    out.volume += volume;
    top = next;
  }
}

}  // namespace

SkinUnderWater skin_under_water(std::span<const Vec3> positions, std::span<const Triangle> triangles, double spacing) {
  SkinUnderWater out;
  if (positions.empty()) return out;
  const Box box = bounds(positions);
  out.top = box.hi.y(), out.bottom = box.lo.y();
  for (const Vec3& p : positions)
    if (p.y() == out.top) out.top_x = p.x(), out.top_z = p.z();
  if (out.bottom >= 0) return out;
  // Columns of the world, so that a skin at rest gives the same volume.
  const double cell = k_columns * spacing, area = spacing * spacing;
  const auto first = [&](double low) { return cell * std::floor(low / cell); };
  ColumnGrid grid{first(box.lo.x()), first(box.lo.z()), cell, 0, 0};
  grid.nx = static_cast<int>((box.hi.x() - grid.x) / cell) + 1;
  grid.nz = static_cast<int>((box.hi.z() - grid.z) / cell) + 1;
  const BodySurface surface{triangles, positions};
  BodyColumns columns;
  columns.find(grid, {&surface, 1}, std::numeric_limits<double>::infinity());
  double moment_x = 0, moment_z = 0;
  for (int c = 0; c < grid.nx * grid.nz; ++c)
    for (int n = columns.start[at(c)]; n < columns.start[at(c) + 1]; ++n) {
      const ColumnSpan& span = columns.spans[at(n)];
      if (span.bottom >= 0 || !std::isfinite(span.top)) continue;  // above the water; through a crack
      const double x = grid.x + cell * (c % grid.nx) + (span.column % k_columns + 0.5) * spacing;
      const double z = grid.z + cell * (c / grid.nx) + (span.column / k_columns + 0.5) * spacing;
      add_column(x, z, span.bottom, span.top, area, spacing, out);
      if (span.top >= 0) out.section += area, moment_x += area * x, moment_z += area * z;
    }
  if (out.section > 0) out.section_x = moment_x / out.section, out.section_z = moment_z / out.section;
  return out;
}

double height_at(const PondModes& m, std::span<const double> heights, double x, double z) {
  const double p = std::clamp(x / m.cell_x() - 0.5, 0.0, m.nx - 1.0),
               q = std::clamp(z / m.cell_z() - 0.5, 0.0, m.nz - 1.0);
  const int i = std::min(static_cast<int>(p), m.nx - 2), j = std::min(static_cast<int>(q), m.nz - 2);
  const double u = p - i, v = q - j;
  const double* at = heights.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(m.stride) + i;
  return (1 - v) * ((1 - u) * at[0] + u * at[1]) + v * ((1 - u) * at[m.stride] + u * at[m.stride + 1]);
}

Wrench skin_force(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                  std::span<const Triangle> triangles, const PondModes& modes, std::span<const double> heights,
                  double gravity, double density) {
  Wrench sum;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 &pa = positions[at(a)], &pb = positions[at(b)], &pc = positions[at(c)];
    if (std::min({pa.y(), pb.y(), pc.y()}) > 1) continue;
    const Vec3 place = (pa + pb + pc) / 3, area = 0.5 * (pb - pa).cross(pc - pa);
    const double depth = height_at(modes, heights, place.x(), place.z()) - place.y();
    if (depth <= 0 || area.squaredNorm() == 0) continue;
    const Vec3 velocity = (velocities[at(a)] + velocities[at(b)] + velocities[at(c)]) / 3;
    const double towards = std::max(0.0, velocity.dot(area.normalized()));
    sum.add(place, -(density * (gravity * depth + 0.5 * towards * towards)) * area);
  }
  return sum;
}

}  // namespace ft::inline solvers

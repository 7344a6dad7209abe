#include "solvers/water/pond/skin_volume.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

struct Hit {
  std::int64_t ray;
  double height;
  int enters;
};

double turn(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x();
}

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
  // Rays of the world, off the round numbers, so that a skin at rest gives the same volume.
  const double off = 0.5137 * spacing;
  const auto columns = static_cast<std::int64_t>((box.hi.x() - box.lo.x()) / spacing) + 3;
  const auto first_x = static_cast<std::int64_t>(std::floor(box.lo.x() / spacing)) - 1;
  const auto first_z = static_cast<std::int64_t>(std::floor(box.lo.z() / spacing)) - 1;
  std::vector<Hit> hits;
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    const Vec2 p(a.x(), a.z()), q(b.x(), b.z()), r(c.x(), c.z());
    const double area = turn(p, q, r);
    if (area == 0) continue;
    const Vec2 lo = p.cwiseMin(q).cwiseMin(r), hi = p.cwiseMax(q).cwiseMax(r);
    const auto cell = [&](double value) { return static_cast<std::int64_t>(std::ceil((value - off) / spacing)); };
    for (std::int64_t k = cell(lo.y()); static_cast<double>(k) * spacing + off <= hi.y(); ++k)
      for (std::int64_t i = cell(lo.x()); static_cast<double>(i) * spacing + off <= hi.x(); ++i) {
        const Vec2 ray(static_cast<double>(i) * spacing + off, static_cast<double>(k) * spacing + off);
        const double u = turn(q, r, ray) / area, v = turn(r, p, ray) / area, w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        hits.push_back({(k - first_z) * columns + (i - first_x), u * a.y() + v * b.y() + w * c.y(), area > 0 ? 1 : -1});
      }
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return a.ray != b.ray ? a.ray < b.ray : a.height != b.height ? a.height < b.height : a.enters > b.enters;
  });
  const double area = spacing * spacing;
  double moment_x = 0, moment_z = 0;
  for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
    int balance = 0;
    for (end = begin; end < hits.size() && hits[end].ray == hits[begin].ray; ++end) balance += hits[end].enters;
    if (balance != 0) continue;  // through a crack
    const double x = static_cast<double>(hits[begin].ray % columns + first_x) * spacing + off;
    const double z = static_cast<double>(hits[begin].ray / columns + first_z) * spacing + off;
    int winding = 0;
    double from = 0;
    for (std::size_t h = begin; h < end; ++h) {
      const int before = winding;
      winding += hits[h].enters;
      if (before <= 0 && winding > 0) from = hits[h].height;
      if (before <= 0 || winding > 0) continue;
      if (from < 0) add_column(x, z, from, hits[h].height, area, spacing, out);
      if (from < 0 && hits[h].height >= 0) out.section += area, moment_x += area * x, moment_z += area * z;
    }
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

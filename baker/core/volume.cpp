#include "baker/core/volume.h"

#include <algorithm>
#include <cmath>

#include "baker/core/lids.h"

namespace ft {
namespace {

/// Of all columns that meet the surface, so many may leave it another number of times than they enter it: rays along
/// edges, cracks.
constexpr double k_most_unbalanced = 0.02;

struct Hit {
  std::size_t column;
  double height;
  int enters;  ///< 1 from outside, -1 from inside
};

/// Twice the signed area of a, b and p in the plane.
double turn(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x();
}

}  // namespace

std::optional<double> enclosed_volume(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                      double spacing) {
  return enclosed_volume(positions, triangles, close_rims(positions, triangles), spacing);
}

std::optional<double> enclosed_volume(std::span<const Vec3> own_positions, std::span<const Triangle> own_triangles,
                                      const Lids& lids, double spacing) {
  CHECK(spacing > 0);
  if (own_positions.empty() || own_triangles.empty()) return {};
  if (lids.share() > k_most_open) return {};
  std::vector<Vec3> positions(own_positions.begin(), own_positions.end());
  positions.insert(positions.end(), lids.middles.begin(), lids.middles.end());
  std::vector<Triangle> triangles(own_triangles.begin(), own_triangles.end());
  triangles.insert(triangles.end(), lids.triangles.begin(), lids.triangles.end());
  const Box box = bounds(positions);
  // Off the round numbers on which modelled vertices lie.
  const Vec2 origin = Vec2(box.lo.x() - 0.5137 * spacing, box.lo.z() - 0.5291 * spacing);
  const auto columns_x = static_cast<std::size_t>(std::ceil((box.hi.x() - origin.x()) / spacing)) + 1;
  const auto cell = [&](double value) { return static_cast<long>(std::ceil(value / spacing)); };
  std::vector<Hit> hits;
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    const Vec2 p = Vec2(a.x(), a.z()) - origin, q = Vec2(b.x(), b.z()) - origin, r = Vec2(c.x(), c.z()) - origin;
    const double area = turn(p, q, r);
    if (area == 0) continue;
    const Vec2 lo = p.cwiseMin(q).cwiseMin(r), hi = p.cwiseMax(q).cwiseMax(r);
    for (long i = cell(lo.x()); static_cast<double>(i) * spacing <= hi.x(); ++i)
      for (long k = cell(lo.y()); static_cast<double>(k) * spacing <= hi.y(); ++k) {
        const Vec2 ray(static_cast<double>(i) * spacing, static_cast<double>(k) * spacing);
        const double u = turn(q, r, ray) / area, v = turn(r, p, ray) / area, w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        // x to z turns downwards: a triangle that is counter-clockwise in this plane faces down, and upwards rays
        // enter.
        hits.push_back({static_cast<std::size_t>(k) * columns_x + static_cast<std::size_t>(i),
                        u * a.y() + v * b.y() + w * c.y(), area > 0 ? 1 : -1});
      }
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return a.column != b.column ? a.column < b.column : a.height < b.height;
  });
  std::size_t columns = 0, unbalanced = 0;
  double length = 0;
  for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
    int winding = 0;
    double inside = 0;
    for (end = begin; end < hits.size() && hits[end].column == hits[begin].column; ++end) {
      if (winding > 0) inside += hits[end].height - hits[end - 1].height;
      winding += hits[end].enters;
    }
    ++columns;
    if (winding == 0)
      length += inside;
    else
      ++unbalanced;
  }
  if (static_cast<double>(unbalanced) > k_most_unbalanced * static_cast<double>(columns) || length <= 0) return {};
  return length * spacing * spacing;
}

Vec3 volume_centre(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  if (positions.empty()) return Vec3::Zero();
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : positions) middle += p / static_cast<double>(positions.size());
  Vec3 moment = Vec3::Zero();
  double volume = 0, size = 0;
  for (const Triangle& t : triangles) {
    const Vec3 a = positions[at(t[0])] - middle, b = positions[at(t[1])] - middle, c = positions[at(t[2])] - middle;
    const double part = a.dot(b.cross(c)) / 6;
    volume += part;
    size += std::abs(part);
    moment += 0.25 * part * (a + b + c);
  }
  return std::abs(volume) > 1e-6 * size ? Vec3(middle + moment / volume) : middle;
}

}  // namespace ft

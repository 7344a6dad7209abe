// See hydrostatics.h.
#include "solvers/water/hydrostatics.h"

#include <array>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// All of it below the level. Pressure times arm is quadratic: the edges' middles integrate it exactly.
void add_part(const std::array<Vec3, 3>& p, double level, double weight, const Vec3& about, Hydrostatics& out) {
  const Vec3 area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 middle = 0.5 * (p[k] + p[(k + 1) % 3]);
    const double depth = level - middle.y();
    out.wrench.add(middle - about, -weight * depth / 3 * area);
    // Columns between the surface and the level: what faces down has them above it.
    out.volume -= depth / 3 * area.y();
  }
}

}  // namespace

Hydrostatics hydrostatics(std::span<const Vec3> positions, std::span<const Triangle> triangles, double level,
                          double weight, const Vec3& about) {
  Hydrostatics out;
  for (const Triangle& t : triangles) {
    std::array<Vec3, 4> kept;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = positions[at(t[k])], &b = positions[at(t[(k + 1) % 3])];
      const bool a_below = a.y() < level, b_below = b.y() < level;
      if (a_below) kept[count++] = a;
      if (a_below != b_below) kept[count++] = a + (level - a.y()) / (b.y() - a.y()) * (b - a);
    }
    if (count >= 3) add_part({kept[0], kept[1], kept[2]}, level, weight, about, out);
    if (count == 4) add_part({kept[0], kept[2], kept[3]}, level, weight, about, out);
  }
  return out;
}

double facing_area(std::span<const Vec3> positions, std::span<const Triangle> triangles, const Vec3& direction) {
  double twice = 0;
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    twice += std::abs((b - a).cross(c - a).dot(direction));
  }
  return 0.25 * twice;
}

}  // namespace ft::inline solvers

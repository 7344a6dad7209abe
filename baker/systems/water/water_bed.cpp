#include "baker/systems/water/water_bed.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ft::inline baker {
namespace {

/// Cells of a row or column whose middles lie between two places, as [first, last].
std::pair<int, int> between(double low, double high, double origin, double cell, int count) {
  const double first = std::ceil((low - origin) / cell - 0.5), last = std::floor((high - origin) / cell - 0.5);
  return {static_cast<int>(std::clamp(first, 0.0, static_cast<double>(count))),
          static_cast<int>(std::clamp(last, -1.0, static_cast<double>(count - 1)))};
}

}  // namespace

WaterBed bed_under(const WaterGrid& grid, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  constexpr double k_none = -std::numeric_limits<double>::infinity();
  WaterBed out;
  out.height.assign(grid.count(), k_none);
  double highest = k_none;
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    highest = std::max({highest, a.y(), b.y(), c.y()});
    const double twice = (b.x() - a.x()) * (c.z() - a.z()) - (c.x() - a.x()) * (b.z() - a.z());
    if (std::abs(twice) < 1e-18) continue;  // stands upright
    const auto [i0, i1] =
        between(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), grid.origin.x(), grid.cell, grid.nx);
    const auto [k0, k1] =
        between(std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()}), grid.origin.y(), grid.cell, grid.nz);
    for (int k = k0; k <= k1; ++k)
      for (int i = i0; i <= i1; ++i) {
        const double x = grid.origin.x() + grid.cell * (i + 0.5), z = grid.origin.y() + grid.cell * (k + 0.5);
        const double of_b = ((x - a.x()) * (c.z() - a.z()) - (c.x() - a.x()) * (z - a.z())) / twice;
        const double of_c = ((b.x() - a.x()) * (z - a.z()) - (x - a.x()) * (b.z() - a.z())) / twice;
        // Edges count for both sides.
        if (of_b < -1e-9 || of_c < -1e-9 || of_b + of_c > 1 + 1e-9) continue;
        double& height = out.height[at(k) * at(grid.nx) + at(i)];
        height = std::max(height, a.y() + of_b * (b.y() - a.y()) + of_c * (c.y() - a.y()));
      }
  }
  for (double& height : out.height)
    if (height == k_none) {
      height = highest == k_none ? 0 : highest;
      ++out.uncovered;
    }
  return out;
}

std::vector<double> depths_that_stay(const WaterGrid& grid, std::span<const double> bed, double level) {
  std::vector<double> out;
  for (const double height : bed) out.push_back(std::max(0.0, level - height));
  std::vector<std::pair<int, int>> runs_off;
  const auto drain = [&](int i, int k) {
    if (i < 0 || k < 0 || i >= grid.nx || k >= grid.nz) return;
    double& depth = out[at(k) * at(grid.nx) + at(i)];
    if (depth > 0) runs_off.emplace_back(i, k);
    depth = 0;
  };
  for (int i = 0; i < grid.nx; ++i) drain(i, 0), drain(i, grid.nz - 1);
  for (int k = 0; k < grid.nz; ++k) drain(0, k), drain(grid.nx - 1, k);
  while (!runs_off.empty()) {
    const auto [i, k] = runs_off.back();
    runs_off.pop_back();
    drain(i - 1, k), drain(i + 1, k), drain(i, k - 1), drain(i, k + 1);
  }
  return out;
}

}  // namespace ft::inline baker

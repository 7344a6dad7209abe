// Points spread over a painted surface, by lot but evenly.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline baker {

struct SurfaceRoot {
  Vec3 place = Vec3::Zero();  ///< m
  int triangle = 0;
  std::array<double, 3> weight{};  ///< barycentric
};

/// Area of each triangle times the mean of its weights [m2].
std::vector<double> painted_areas(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                  std::span<const double> weight);

/// `count` of them; dense where the weight is large. Some triangle is painted.
std::vector<SurfaceRoot> spread_roots(int count, std::uint64_t seed, std::span<const Vec3> positions,
                                      std::span<const Triangle> triangles, std::span<const double> weight);

}  // namespace ft::inline baker

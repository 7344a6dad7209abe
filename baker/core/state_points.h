// Points in a state's blocks, bit for bit.
#pragma once

#include "baker/core/check.h"
#include "baker/core/state.h"

namespace ft {

/// As a block's numbers.
inline std::vector<double> flat(std::span<const Vec3> points) {
  const double* begin = points.empty() ? nullptr : points[0].data();
  return {begin, begin + 3 * points.size()};
}

/// The `count` points of a block; a state without it is a fault of the program.
inline std::vector<Vec3> points_of(const State& state, std::string_view name, std::size_t count) {
  const auto* values = state.find(name);
  CHECK(values && values->size() == 3 * count);
  const auto view = as_points(*values);
  return {view.begin(), view.end()};
}

}  // namespace ft

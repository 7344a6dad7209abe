#include "solvers/standins/body_state.h"

#include <cmath>
#include <numbers>

#include "baker/core/check.h"

namespace ft::inline solvers {

std::vector<ShapeSample> sphere_shape(double radius, int across) {
  CHECK(radius > 0 && across >= 1);
  std::vector<ShapeSample> out;
  // The grid's cells whose middle is inside share the volume of the ball.
  const double cell = 2 * radius / across;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j)
      for (int k = 0; k < across; ++k) {
        const Vec3 place = cell * Vec3(i + 0.5, j + 0.5, k + 0.5) - Vec3::Constant(radius);
        if (place.norm() > radius) continue;
        ShapeSample& sample = out.emplace_back();
        sample.place = place;
      }
  const double volume = 4 * std::numbers::pi / 3 * radius * radius * radius / static_cast<double>(out.size());
  for (ShapeSample& sample : out) sample.volume = volume;
  // A Fibonacci lattice: equal areas.
  const int count = across * across;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1.0) / count, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    ShapeSample& sample = out.emplace_back();
    sample.normal = Vec3(std::sqrt(1 - y * y) * std::cos(turn), y, std::sqrt(1 - y * y) * std::sin(turn));
    sample.place = radius * sample.normal;
    sample.area = 4 * std::numbers::pi * radius * radius / count;
  }
  return out;
}

std::vector<ShapeSample> box_shape(const Vec3& size, int across) {
  CHECK(size.minCoeff() > 0 && across >= 1);
  std::vector<ShapeSample> out;
  const auto middle = [&](int i, int axis) { return ((i + 0.5) / across - 0.5) * size[axis]; };
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      for (int k = 0; k < across; ++k) {
        ShapeSample& sample = out.emplace_back();
        sample.place = Vec3(middle(i, 0), middle(j, 1), middle(k, 2));
        sample.volume = size.prod() / (across * across * across);
      }
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          ShapeSample& sample = out.emplace_back();
          sample.normal[axis] = side;
          sample.place[axis] = 0.5 * side * size[axis];
          sample.place[u] = middle(i, u), sample.place[v] = middle(j, v);
          sample.area = size[u] * size[v] / (across * across);
        }
    }
  return out;
}

std::vector<ShapeSample> surface_shape(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::vector<ShapeSample> out;
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    const Vec3 cross = (b - a).cross(c - a);
    if (cross.isZero(0)) continue;
    ShapeSample& sample = out.emplace_back();
    sample.place = (a + b + c) / 3;
    sample.normal = cross.normalized();
    sample.area = 0.5 * cross.norm();
  }
  return out;
}

}  // namespace ft::inline solvers

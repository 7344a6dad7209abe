// A body of open shells, as characters are made of several meshes: a closed trunk, a cap over its head, a card beside
// it (hair), an open-ended tube about it (a sleeve). For the tests of winding numbers and penetrations.
#pragma once

#include <cmath>
#include <numbers>

#include "capsule_scene.h"

namespace ft::test {

inline void append(Shape& body, const Shape& shell) {
  const int first = static_cast<int>(body.positions.size());
  body.positions.insert(body.positions.end(), shell.positions.begin(), shell.positions.end());
  for (const Triangle& t : shell.triangles) body.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// Rings of points about the vertical through `foot`, from below; faces outwards, open at both ends.
inline Shape lathe(const Vec3& foot, std::span<const Vec2> radius_and_height, int segments = 24) {
  Shape s;
  for (const Vec2& ring : radius_and_height)
    for (int k = 0; k < segments; ++k) {
      const double a = 2 * std::numbers::pi * k / segments;
      s.positions.push_back(foot + Vec3(ring.x() * std::cos(a), ring.y(), ring.x() * std::sin(a)));
    }
  for (int r = 0; r + 1 < static_cast<int>(radius_and_height.size()); ++r)
    for (int k = 0; k < segments; ++k) {
      const int a = r * segments + k, b = r * segments + (k + 1) % segments;
      s.triangles.push_back({a, a + segments, b});
      s.triangles.push_back({b, a + segments, b + segments});
    }
  return s;
}

/// Of a ball's upper half, about its centre.
inline Shape dome(const Vec3& centre, double radius, int rings = 10) {
  std::vector<Vec2> profile;
  for (int r = 0; r <= rings; ++r) {
    const double a = 0.4995 * std::numbers::pi * r / rings;
    profile.emplace_back(radius * std::cos(a), radius * std::sin(a));
  }
  return lathe(centre, profile);
}

inline Shape tube(const Vec3& foot, double radius, double height) {
  std::vector<Vec2> profile;
  for (int r = 0; r <= 12; ++r) profile.emplace_back(radius, height * r / 12);
  return lathe(foot, profile);
}

/// Faces along +z.
inline Shape card(const Vec3& centre, double width, double height) {
  Shape s;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 2; ++i)
      s.positions.push_back(centre + Vec3(width * (i / 2.0 - 0.5), height * (j / 4.0 - 0.5), 0));
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 2; ++i) {
      const int a = 3 * j + i;
      s.triangles.push_back({a, a + 1, a + 4});
      s.triangles.push_back({a, a + 4, a + 3});
    }
  return s;
}

/// About 1 m tall, 0.3 m wide.
inline Shape body_of_open_shells() {
  Shape s = capsule({0, 0.15, 0}, {0, 0.75, 0}, 0.12);
  append(s, dome({0, 0.8, 0}, 0.16));
  append(s, card({0.02, 0.6, 0.2}, 0.1, 0.4));
  append(s, tube({0.3, 0.2, 0}, 0.07, 0.4));
  return s;
}

}  // namespace ft::test

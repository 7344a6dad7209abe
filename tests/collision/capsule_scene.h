// Closed capsules and the bodies made of them, for the tests of the feasible collider, penetrations and crossings.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "baker/core/trajectory.h"

namespace ft::test {

struct Shape {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};

/// Closed capsule around the segment p..q with long side triangles, as a bone's body has them.
inline Shape capsule(const Vec3& p, const Vec3& q, double radius, int segments = 20, int cap_rings = 6) {
  Shape s;
  const Vec3 z = (q - p).norm() > 0 ? (q - p).normalized().eval() : Vec3::UnitZ().eval();
  const Vec3 x = z.unitOrthogonal(), y = z.cross(x);
  s.positions.push_back(p - radius * z);
  const auto ring = [&](const Vec3& centre, double angle) {
    for (int k = 0; k < segments; ++k) {
      const double a = 2 * std::numbers::pi * k / segments;
      s.positions.push_back(centre +
                            radius * (std::sin(angle) * z + std::cos(angle) * (std::cos(a) * x + std::sin(a) * y)));
    }
  };
  for (int k = 1; k <= cap_rings; ++k) ring(p, 0.5 * std::numbers::pi * (k - cap_rings) / cap_rings);
  for (int k = 0; k < cap_rings; ++k) ring(q, 0.5 * std::numbers::pi * k / cap_rings);
  const int last = static_cast<int>(s.positions.size());
  s.positions.push_back(q + radius * z);
  const auto v = [&](int r, int k) { return 1 + r * segments + k % segments; };
  for (int k = 0; k < segments; ++k) s.triangles.push_back({0, v(0, k + 1), v(0, k)});
  for (int r = 0; r + 1 < 2 * cap_rings; ++r)
    for (int k = 0; k < segments; ++k) {
      s.triangles.push_back({v(r, k), v(r, k + 1), v(r + 1, k + 1)});
      s.triangles.push_back({v(r, k), v(r + 1, k + 1), v(r + 1, k)});
    }
  for (int k = 0; k < segments; ++k)
    s.triangles.push_back({last, v(2 * cap_rings - 1, k), v(2 * cap_rings - 1, k + 1)});
  return s;
}

/// A body of capsules, one part each; pose() places every part anew.
struct CapsuleBody {
  struct Bone {
    std::string name;
    Vec3 p, q;
    double radius;
    int parent;
  };
  std::vector<Bone> bones;
  Surface surface;

  explicit CapsuleBody(std::vector<Bone> in) : bones(std::move(in)) {
    int first = 0;
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Shape s = capsule(bones[b].p, bones[b].q, bones[b].radius);
      for (const Triangle& t : s.triangles) surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      surface.part_of_vertex.insert(surface.part_of_vertex.end(), s.positions.size(), static_cast<int>(b));
      first += static_cast<int>(s.positions.size());
      const double r = bones[b].radius, length = (bones[b].q - bones[b].p).norm();
      surface.parts.push_back({bones[b].name, bones[b].parent, std::numbers::pi * r * r * (length + 4.0 / 3.0 * r)});
    }
  }
  /// Positions with every bone's capsule moved rigidly by its isometry.
  std::vector<Vec3> pose(std::span<const Eigen::Isometry3d> moves) const {
    std::vector<Vec3> out;
    for (std::size_t b = 0; b < bones.size(); ++b)
      for (const Vec3& x : capsule(bones[b].p, bones[b].q, bones[b].radius).positions) out.push_back(moves[b] * x);
    return out;
  }
  std::vector<Vec3> bind() const {
    return pose(std::vector<Eigen::Isometry3d>(bones.size(), Eigen::Isometry3d::Identity()));
  }
};

}  // namespace ft::test

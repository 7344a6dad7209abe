// See shapes.h.
#include "tests/support/torture/shapes.h"

#include <cmath>
#include <numbers>

#include "baker/core/check.h"

namespace ft::torture {

Shape lathe(const std::vector<Vec2>& profile, bool closed, int segments) {
  Shape out;
  std::vector<int> first;  // of each ring; a point on the axis is a ring of one
  const auto on_axis = [&](std::size_t r) { return profile[r].x() == 0; };
  for (std::size_t r = 0; r < profile.size(); ++r) {
    first.push_back(static_cast<int>(out.points.size()));
    for (int s = 0; s < (on_axis(r) ? 1 : segments); ++s) {
      const double around = 2 * std::numbers::pi * s / segments;
      out.points.push_back({profile[r].x() * std::cos(around), profile[r].y(), -profile[r].x() * std::sin(around)});
    }
  }
  const auto vertex = [&](std::size_t r, int s) { return first[r] + (on_axis(r) ? 0 : s % segments); };
  for (std::size_t r = 0; r + (closed ? 0 : 1) < profile.size(); ++r) {
    const std::size_t next = (r + 1) % profile.size();
    for (int s = 0; s < segments; ++s) {
      if (!on_axis(next)) out.triangles.push_back({vertex(r, s), vertex(next, s), vertex(next, s + 1)});
      if (!on_axis(r)) out.triangles.push_back({vertex(r, s), vertex(next, s + 1), vertex(r, s + 1)});
    }
  }
  return out;
}

Shape capsule(double top, double bottom, double radius, int rings, int segments) {
  std::vector<Vec2> profile;
  constexpr int k_cap = 6;
  for (int i = 0; i <= k_cap; ++i) {
    const double a = 0.5 * std::numbers::pi * i / k_cap;
    profile.push_back({i == 0 ? 0 : radius * std::sin(a), top - radius + radius * std::cos(a)});
  }
  for (int i = 1; i < rings; ++i) profile.push_back({radius, top - radius + (bottom - top + 2 * radius) * i / rings});
  for (int i = 0; i <= k_cap; ++i) {
    const double a = 0.5 * std::numbers::pi * i / k_cap;
    profile.push_back({i == k_cap ? 0 : radius * std::cos(a), bottom + radius - radius * std::sin(a)});
  }
  return lathe(profile, false, segments);
}

Shape box(const Vec3& sides) {
  Shape out;
  for (int i = 0; i < 8; ++i)
    out.points.push_back(0.5 * sides.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  const std::array<std::array<int, 4>, 6> faces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& f : faces) out.triangles.insert(out.triangles.end(), {{f[0], f[1], f[2]}, {f[0], f[2], f[3]}});
  return out;
}

Shape moved(Shape shape, const Vec3& by) {
  for (Vec3& p : shape.points) p += by;
  return shape;
}

Pose shift(const Vec3& by) {
  return Pose(Eigen::Translation3d(by));
}

Pose turn(const Vec3& pivot, const Vec3& axis, double angle) {
  return Eigen::Translation3d(pivot) * Eigen::AngleAxisd(angle, axis.normalized()) * Eigen::Translation3d(-pivot);
}

RigidParts& RigidParts::add(const std::string& name, const Shape& shape, RigidMotion motion) {
  const int first = static_cast<int>(points_.size()), part = static_cast<int>(motions_.size());
  points_.insert(points_.end(), shape.points.begin(), shape.points.end());
  for (const Triangle& t : shape.triangles) surface_.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  surface_.part_of_vertex.resize(points_.size(), part);
  surface_.parts.push_back({name, -1, 1.0 / (1 + part)});
  motions_.push_back(std::move(motion));
  return *this;
}

std::shared_ptr<ScriptedBody> RigidParts::build() const {
  const auto place = [parts = surface_.part_of_vertex, points = points_, motions = motions_](double time,
                                                                                             std::span<Vec3> out) {
    std::vector<Pose> poses;
    for (const RigidMotion& motion : motions) poses.push_back(motion(time));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = poses[at(parts[i])] * points[i];
  };
  std::vector<Vec3> bind(points_.size());
  place(0, bind);
  return std::make_shared<ScriptedBody>(surface_, bind, 0, place);
}

double ease(double time, double from, double to) {
  const double t = std::clamp((time - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Mesh grid(const std::string& name, int columns, int rows, bool round,
          const std::function<Vec3(double, double)>& place) {
  const int across = round ? columns : columns + 1;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < across; ++i)
      points.push_back(place(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * across + i, b = j * across + (i + 1) % across, c = a + across, d = b + across;
      if ((i + j) % 2 == 0)
        triangles.insert(triangles.end(), {{a, c, d}, {a, d, b}});
      else
        triangles.insert(triangles.end(), {{a, c, b}, {b, c, d}});
    }
  return make_triangle_mesh(name, std::move(points), triangles);
}

}  // namespace ft::torture

// A primary whose motion is a function: a sphere or any mesh that tests move by formula or from an array.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "baker/core/trajectory.h"

namespace ft {

class ScriptedBody final : public Trajectory {
 public:
  using Motion = std::function<void(double time, std::span<Vec3> positions)>;
  /// One part unless the surface says otherwise. bind: pose that garments are modelled on [m].
  ScriptedBody(Surface surface, std::vector<Vec3> bind, double preroll, Motion motion)
      : surface_(std::move(surface)), bind_(std::move(bind)), preroll_(preroll), motion_(std::move(motion)) {
    if (surface_.parts.empty()) surface_.parts.push_back({"body", -1, 1.0});
    surface_.part_of_vertex.resize(bind_.size(), 0);
  }
  const Surface& surface() const override { return surface_; }
  void bind_pose(std::span<Vec3> positions) const override { std::copy(bind_.begin(), bind_.end(), positions.begin()); }
  void sample(double time, std::span<Vec3> positions) const override {
    std::copy(bind_.begin(), bind_.end(), positions.begin());
    motion_(time, positions);
  }
  Eigen::Isometry3d bind_to_start() const override { return Eigen::Isometry3d::Identity(); }
  double preroll() const override { return preroll_; }

 private:
  Surface surface_;
  std::vector<Vec3> bind_;
  double preroll_;
  Motion motion_;
};

/// Latitude-longitude sphere around the origin, closed, outward counter-clockwise.
inline void make_sphere(double radius, int rings, int segments, std::vector<Vec3>& points,
                        std::vector<Triangle>& triangles) {
  const int first = static_cast<int>(points.size());
  points.push_back({0, radius, 0});
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double polar = std::numbers::pi * r / rings, around = 2 * std::numbers::pi * s / segments;
      points.push_back(radius *
                       Vec3(std::sin(polar) * std::cos(around), std::cos(polar), -std::sin(polar) * std::sin(around)));
    }
  points.push_back({0, -radius, 0});
  const int last = static_cast<int>(points.size()) - 1;
  const auto ring = [&](int r, int s) { return first + 1 + (r - 1) * segments + s % segments; };
  for (int s = 0; s < segments; ++s) {
    triangles.push_back({first, ring(1, s), ring(1, s + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      triangles.push_back({ring(r, s), ring(r + 1, s), ring(r + 1, s + 1)});
      triangles.push_back({ring(r, s), ring(r + 1, s + 1), ring(r, s + 1)});
    }
    triangles.push_back({last, ring(rings - 1, s + 1), ring(rings - 1, s)});
  }
}

/// Square sheet of cells x cells, side [m], in the plane y = height, centred; alternating diagonals.
inline Mesh make_sheet(double side, int cells, double height) {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  const int n = cells + 1;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      points.push_back({side * (i / double(cells) - 0.5), height, side * (j / double(cells) - 0.5)});
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = j * n + i, b = a + 1, c = a + n, d = c + 1;
      if ((i + j) % 2 == 0)
        triangles.insert(triangles.end(), {{a, c, d}, {a, d, b}});
      else
        triangles.insert(triangles.end(), {{a, c, b}, {b, c, d}});
    }
  return make_triangle_mesh("sheet", std::move(points), triangles);
}

}  // namespace ft

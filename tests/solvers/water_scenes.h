// What tests of water in columns share: beds and depths from formulas, bodies that float and bodies that are driven.
#pragma once

#include <cmath>
#include <functional>

#include "baker/core/shapes.h"
#include "solvers/water/water_body.h"

namespace ft::test {

inline constexpr double k_g = 9.81;

/// Depth of each cell from its middle.
template <class Setup>
void set_depth(Setup& s, const std::function<double(double x, double z)>& depth) {
  s.depth.clear();
  for (int k = 0; k < s.nz; ++k)
    for (int i = 0; i < s.nx; ++i)
      s.depth.push_back(depth(s.origin.x() + (i + 0.5) * s.cell, s.origin.y() + (k + 0.5) * s.cell));
}

template <class Setup>
void set_bed(Setup& s, const std::function<double(double x, double z)>& bed) {
  s.bed.clear();
  for (int k = 0; k < s.nz; ++k)
    for (int i = 0; i < s.nx; ++i)
      s.bed.push_back(bed(s.origin.x() + (i + 0.5) * s.cell, s.origin.y() + (k + 0.5) * s.cell));
}

/// A body of even density on a surface about the origin.
inline PlacedFloat floating(std::string name, const TriangleSurface& surface, double density, const Vec3& position,
                            double drag = 0) {
  PlacedFloat f;
  f.body.name = std::move(name);
  f.body.positions = surface.positions;
  f.body.triangles = surface.triangles;
  f.body.drag = drag;
  double volume = 0;
  Mat3 second = Mat3::Zero();  // the integral of x x^T
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = surface.positions[at(t[0])], &b = surface.positions[at(t[1])], &c = surface.positions[at(t[2])];
    const double part = a.dot(b.cross(c)) / 6;
    volume += part;
    const Vec3 sum = a + b + c;
    second += part / 20 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  f.body.mass.mass = density * volume;
  f.body.mass.inertia = density * (second.trace() * Mat3::Identity() - second);
  f.start.pose.position = position;
  return f;
}

/// A surface that is driven: where it is at a time.
struct Driven {
  TriangleSurface surface;
  std::function<Vec3(double time)> place;
  std::vector<Vec3> from, to;

  DrivenBody frame(double time0, double time1) {
    from.clear(), to.clear();
    for (const Vec3& p : surface.positions) from.push_back(p + place(time0)), to.push_back(p + place(time1));
    return {surface.triangles, from, to};
  }
};

}  // namespace ft::test

// Strands of real hair for tests.
#pragma once

#include <gtest/gtest.h>

#include <numbers>

#include "baker/core/random.h"
#include "solvers/hair/hair_setup.h"
#include "solvers/hair/rod_step.h"

namespace ft::test {

/// What follows for a strand of the solver's own hair.
struct OneHair : HairMaterial {
  double area() const { return std::numbers::pi * radius * radius; }
  double bend() const { return young * std::numbers::pi * std::pow(radius, 4) / 4; }
  double twist() const { return shear * std::numbers::pi * std::pow(radius, 4) / 2; }
  double weight() const { return density * area() * k_gravity; }          // by length [N/m]
  double bending_length() const { return std::cbrt(bend() / weight()); }  // [m]
};

/// A straight strand of n vertices on the hair, and a ghost, along `way`.
inline Rod<double> straight_rod(int n, double length, const OneHair& m) {
  Rod<double> rod;
  rod.n = n + 1;
  const double l = length / (n - 1);
  rod.length.assign(at(n), l);
  rod.voronoi.assign(at(n + 1), l);
  rod.voronoi[1] = 0.5 * l;
  rod.mass.assign(at(n + 1), m.density * m.area() * l);
  rod.mass.back() *= 0.5;
  rod.k1.assign(at(n + 1), 0), rod.k2 = rod.tw = rod.k1;
  rod.stretch = m.young * m.area();
  rod.bend = m.bend();
  rod.twist = m.twist();
  return rod;
}
inline RodPose<double> straight_pose(const Rod<double>& rod, const Vec3& way, const Vec3& director) {
  RodPose<double> pose;
  for (int i = 0; i < rod.n; ++i) pose.x.push_back(plain(Vec3((i - 1) * rod.length[0] * way)));
  pose.director.assign(at(rod.n - 1), plain(director));
  return pose;
}

}  // namespace ft::test

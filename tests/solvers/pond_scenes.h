// Ponds with bodies in them, for tests.
#pragma once

#include "baker/core/equimomental.h"
#include "baker/core/shapes.h"
#include "solvers/water/pond/pond_solver.h"

namespace ft {

/// Of a density relative to water's; its volume is a ball's, its mass even. height: of its centre above the level.
inline PondFloat floating(const TriangleSurface& surface, double volume, double density, const Vec3& place,
                          std::string name = "ball") {
  PondFloat f;
  f.body.name = std::move(name);
  f.body.positions = surface.positions;
  f.body.triangles = surface.triangles;
  f.body.mass = filled_mass(surface.positions, surface.triangles, 1000 * density * volume).mass;
  f.start.pose.position = place;
  return f;
}

/// A sphere whose mesh has exactly the ball's volume.
inline PondFloat floating_ball(double radius, double density, const Vec3& place, std::string name = "ball") {
  TriangleSurface s = sphere_surface(radius, 3);
  double volume = 0;
  for (const Triangle& t : s.triangles)
    volume += s.positions[at(t[0])].dot(s.positions[at(t[1])].cross(s.positions[at(t[2])])) / 6;
  const double ball = 4.0 / 3 * 3.14159265358979323846 * radius * radius * radius;
  for (Vec3& p : s.positions) p *= std::cbrt(ball / volume);
  return floating(s, ball, density, place, std::move(name));
}

inline PondFloat floating_box(const Vec3& size, double density, const Vec3& place, std::string name = "box") {
  return floating(box_surface(size), size.prod(), density, place, std::move(name));
}

/// A square pool with gravity 9.81 and the corner at the origin.
inline PondSetup square_pond(double size, int cells, double depth) {
  PondSetup s;
  s.size_x = s.size_z = size;
  s.nx = s.nz = cells;
  s.depth = depth;
  s.gravity = 9.81;
  return s;
}

inline std::unique_ptr<PondSolver> made(PondSetup setup) {
  auto out = PondSolver::make(std::move(setup));
  CHECK(out.ok());
  return std::move(out).value();
}

/// Extremes and zeros of a swinging height, by parabolas and lines.
struct Swing {
  std::vector<double> zeros, extremes, extreme_times;
  void add(double time, double value) {
    t_.push_back(time), v_.push_back(value);
    const std::size_t n = v_.size();
    if (n >= 2 && (v_[n - 2] > 0) != (v_[n - 1] > 0))
      zeros.push_back(t_[n - 2] + (t_[n - 1] - t_[n - 2]) * v_[n - 2] / (v_[n - 2] - v_[n - 1]));
    if (n < 3) return;
    const double a = v_[n - 3], b = v_[n - 2], c = v_[n - 1];
    if ((b - a) * (c - b) >= 0) return;
    const double curve = a - 2 * b + c, place = 0.5 * (a - c) / curve;
    extremes.push_back(b - 0.25 * (a - c) * place);
    extreme_times.push_back(t_[n - 2] + place * (t_[n - 1] - t_[n - 2]));
  }

 private:
  std::vector<double> t_, v_;
};

}  // namespace ft

// The waves of a rectangular pool: standing cosine waves between its walls, each with its exact frequency
// (Airy 1845: w^2 = g k tanh kH). In this basis water costs a few multiplications per wave and step, nothing is
// dispersed by a grid, and a wall is a mirror. Places are pool coordinates: x and z from the corner, height above rest.
#pragma once

#include <span>
#include <vector>

#include "solvers/water/pond/cosine_transform.h"

namespace ft::inline solvers {

/// Model: never changes. Waves lie row after row: k + stride * l, padding at a row's end is zero for ever.
struct PondModes {
  /// nx, nz: even; lengths, depth [m]; gravity [m/s2]; tension over density [m3/s2].
  PondModes(int nx, int nz, double length_x, double length_z, double depth, double gravity, double tension);

  std::size_t size() const { return static_cast<std::size_t>(stride) * static_cast<std::size_t>(nz); }
  double area() const { return length_x * length_z; }
  double cell_x() const { return length_x / nx; }
  double cell_z() const { return length_z / nz; }
  /// Fastest wave's angular frequency [rad/s].
  double fastest() const;

  int nx, nz, stride;  ///< stride: nx up to a multiple of 4
  double length_x, length_z, depth, gravity;
  std::vector<double> kx, kz;     ///< of columns (stride), rows (nz) [1/m]
  std::vector<double> k;          ///< of each wave [1/m]
  std::vector<double> rise;       ///< k tanh kH: vertical velocity = rise * potential [1/m]
  std::vector<double> stiffness;  ///< g + tension k^2 [m/s2]; empty without tension
  CosineTransform transform;
};

/// Energy of waves over density: 1/2 (g |eta|^2 + P rise P), integrated over the pool [m5/s2].
double wave_energy(const PondModes& modes, std::span<const double> eta, std::span<const double> potential);

/// A place's phases on both axes: cosines and derivatives with respect to the place.
struct Phases {
  std::vector<double> cos_x, sin_x;  ///< cos(kx x), -kx sin(kx x); stride
  std::vector<double> cos_z, sin_z;  ///< nz
  void set(const PondModes& modes, double x, double z);
};

}  // namespace ft::inline solvers

// Hair against hair: strands are splatted on a grid as a fluid is. Where they are denser than they were combed they
// push each other apart, and all are slowed towards the mean motion about them. Strands stay independent within a step:
// what they feel is that of its start. After Petrovic, Henne and Anderson 2005, "Volumetric methods for simulation and
// rendering of hair"; departs from it: density is measured against that of the groom, so that the groom stands still.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline solvers {

struct CrowdSettings {
  double cell = 0.015;    ///< m; grows with the distance of strands, and where they fly far apart
  double pressure = 1.5;  ///< per share that is too dense: the square of a speed [m2/s2]; 0 none
  double spare = 0.5;     ///< share by which it may be denser [1]
};

class HairCrowd {
 public:
  /// groom: all points as combed [m]; mass: of each [kg].
  HairCrowd(const CrowdSettings& settings, std::span<const Vec3> groom, std::span<const double> mass);

  /// At all points in the frame that the groom turns with, so that it meets the grid as it was combed:
  /// positions and velocities along its axes, as many as in the groom. Accelerations by density [m/s2], at most a
  /// quarter of a cell in a step of h [s], and the mean motion there by `v` [m/s].
  void feel(std::span<const Vec3> x, std::span<const Vec3> v, double h, std::vector<Vec3>& push,
            std::vector<Vec3>& flow);

 private:
  struct Cell {
    double mass = 0, pressed = 0;  ///< kg; mass times pressure of what is in it
    Vec3 momentum = Vec3::Zero();
  };
  struct Spot {
    std::size_t first = 0;  ///< cell at its lower corner
    Vec3 share = Vec3::Zero();
  };
  std::size_t cell_of(const Spot& spot, int corner) const;
  double mass_around(const Spot& spot) const;
  void splat(std::span<const Vec3> x, std::span<const Vec3> v);

  CrowdSettings settings_;
  std::vector<double> mass_, combed_;  ///< of each point; mass of a cell about it that it may have: the groom's [kg]
  // Scratch of a step.
  double cell_ = 0;
  std::array<std::size_t, 3> stride_{};
  std::vector<Cell> cells_;
  std::vector<Spot> spots_;
};

}  // namespace ft::inline solvers

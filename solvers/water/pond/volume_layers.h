// What is put into the water from many small places at once (a skin's volume, cavities, droplets that land or leave):
// gathered on the grid in layers of depth, then given to the waves with exp(-k depth). One transform for each layer
// that holds anything, however many places there were.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solvers/water/pond/pond_modes.h"

namespace ft::inline solvers {

class VolumeLayers {
 public:
  /// unit: the least depth [m], in which one drop is rounded off; about a cell and a half.
  VolumeLayers(const PondModes& modes, double unit);
  /// A volume [m3] (or whatever is to be spread) at a place of the pool and a depth below rest [m]. Places outside go
  /// to the nearest cell.
  void add(double x, double z, double depth, double volume);
  bool empty() const;
  /// Adds the gathered to coefficients of waves: heights where volumes were given. Empties the layers.
  void pour(std::span<double> waves);

 private:
  const PondModes* modes_;
  std::vector<double> depths_;
  std::vector<std::vector<double>> layers_;  ///< empty where nothing was given
  std::vector<char> used_;
};

}  // namespace ft::inline solvers

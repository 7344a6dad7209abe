// The velocities of a grid from a file.
#pragma once

#include "solvers/wind/velocity_grid.h"
#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

class GridWind final : public WindField {
 public:
  using WindField::WindField;
  static Result<std::unique_ptr<WindField>> make(const WindFieldSpec& spec);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override { return spec().grid->fastest(); }
};

}  // namespace ft::inline solvers

// A body that stands in the wind. From a place it is looked for against the wind, in five rays a hand's breadth apart,
// so that its edge is soft; what is hit at a distance s shelters as 1 / (1 + (s / 6 R)^2), R: the radius of a sphere
// with its surface. Behind a bluff body the air is slow for six to ten of its widths.
#pragma once

#include <memory>

#include "baker/core/trajectory.h"
#include "solvers/wind/wind.h"

namespace ft::inline solvers {

class SurfaceShelter final : public Shelter {
 public:
  explicit SurfaceShelter(std::shared_ptr<const Trajectory> body);
  std::unique_ptr<Now> at_time(double time) const override;

 private:
  std::shared_ptr<const Trajectory> body_;
  double radius_ = 0;  ///< m
};

}  // namespace ft::inline solvers

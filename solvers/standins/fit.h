// A stand-in's constants from recorded forces: F = -c v - k d by least squares, c and k not below 0. What a one-way
// bake records is an upper bound, because its primary does not yield.
#pragma once

#include <span>
#include <string>

#include "baker/core/types.h"

namespace ft::inline solvers {

struct ForceSample {
  Vec3 force = Vec3::Zero();         ///< on the body [N]
  Vec3 velocity = Vec3::Zero();      ///< of the body [m/s]
  Vec3 displacement = Vec3::Zero();  ///< from where a recoil would be nothing [m]; zero everywhere: none is fitted
};

struct StandInFit {
  double damping = 0;    ///< c [kg/s]
  double stiffness = 0;  ///< k [N/m]
  double r2 = 0;         ///< share of the squared force that it explains, 0 to 1
  int samples = 0;

  /// "c = 3.9 kg/s explains 93 % of the force (R2 0.932, 48 samples)".
  std::string text() const;
};

StandInFit fit_stand_in(std::span<const ForceSample> samples);

}  // namespace ft::inline solvers

// Wind over level ground: slower towards it, by the logarithmic law of the surface layer in the form whose speed is
// zero on the ground itself (Richards and Hoxey 1993, without displacement height). Above the surface layer it is
// constant.
#pragma once

#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

struct LogProfile {
  double roughness_length = 0.01;  ///< z0 [m], > 0 and below reference_height
  double reference_height = 10;    ///< above the ground, where the share is 1 [m]
  double ground = 0;               ///< its height [m]

  /// Height above the ground from which it does not grow any more [m].
  double top() const;
  /// Of the velocity at reference_height, at a height y [m]: 0 on the ground and below, never falling upwards.
  double share(double y) const;
};

/// Another field, which is the same at all places, times the share of each height.
class ProfiledWind final : public WindField {
 public:
  ProfiledWind(std::unique_ptr<WindField> uniform, const LogProfile& profile);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override;
  /// Where it has no part upwards.
  bool is_divergence_free() const override;

 private:
  std::unique_ptr<WindField> uniform_;
  LogProfile profile_;
};

}  // namespace ft::inline solvers

// The same velocity everywhere, with gusts: its speed and, less, its heading change in time as a sum of waves with
// seeded phases, the slowest of which are four times as long as a gust lasts and the fastest a fourth.
#pragma once

#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

class UniformWind final : public WindField {
 public:
  explicit UniformWind(WindFieldSpec spec);
  static Result<std::unique_ptr<WindField>> make(const WindFieldSpec& spec);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override;
  bool is_divergence_free() const override { return true; }

 private:
  struct Wave {
    double rate = 0;           ///< rad/s
    double phase[2] = {0, 0};  ///< of speed and heading [rad]
  };
  std::vector<Wave> waves_;
};

}  // namespace ft::inline solvers

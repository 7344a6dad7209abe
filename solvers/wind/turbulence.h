// Turbulence without divergence: a sum of seeded waves, each across its own direction,
//   u = sum_n A_n cos(k_n . (x - V t) + w_n t) + B_n sin(...),   A_n . k_n = B_n . k_n = 0
// with the energy of Kolmogorov's spectrum from the given length down to an eighth of it (Kraichnan 1970, Phys. Fluids
// 13; Fung, Hunt, Malik, Perkins 1992, J. Fluid Mech. 236). Eddies drift with V and live as long as they take to turn
// over.
#pragma once

#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

/// The waves, of which each component has a root mean square of 1.
class TurbulentWaves {
 public:
  /// length: of the larger eddies [m]; turnover: how fast they change where nothing drifts [m/s].
  TurbulentWaves(double length, double turnover, const Vec3& drift, std::uint64_t seed);
  struct Wave {
    Vec3 k, cosine, sine;
    double phase = 0;
  };
  /// With the phases of a time.
  std::vector<Wave> at_time(double time) const;
  static Vec3 velocity(std::span<const Wave> waves, const Vec3& place);
  /// Of the sum.
  double most() const;

 private:
  std::vector<Wave> waves_;
  std::vector<double> rates_;  ///< of the phases [rad/s]
};

class Turbulence final : public WindField {
 public:
  explicit Turbulence(WindFieldSpec spec);
  static Result<std::unique_ptr<WindField>> make(const WindFieldSpec& spec);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override { return spec().intensity * waves_.most(); }
  bool is_divergence_free() const override { return true; }

 private:
  TurbulentWaves waves_;
};

}  // namespace ft::inline solvers

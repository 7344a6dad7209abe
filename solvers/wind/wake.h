// The wind that moving bodies make. Each body (a part of a character, a prop) pushes the air ahead of it aside as a
// sphere of its drag area does (potential flow), and leaves behind it, along its stored path, what its drag has done to
// the air: in every interval the impulse rho/2 U^2 C_d A dt, in a Gaussian about the piece of path that spreads as
//   sigma^3 = sigma_0^3 + c C_d A X       X: path since then [m]
// as the wake of a body without lift does (Schlichting 1979, 24.5), so that through any plane behind it goes rho/2 U^2
// C_d A of momentum. With it go a pair of vortices that turn against each other about the path, as behind runners and
// cyclists (Crouch et al. 2014, J. Fluid Mech. 748), down in the middle and up at the sides, and turbulence. It is
// whole for two seconds and gone after five. It knows no ground, and wakes that meet add up.
#pragma once

#include "solvers/wind/body_paths.h"
#include "solvers/wind/turbulence.h"
#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

class Wake final : public WindField {
 public:
  explicit Wake(WindFieldSpec spec);
  static Result<std::unique_ptr<WindField>> make(const WindFieldSpec& spec);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override;

  /// Half-width of the wake after a way [m]: of the Gaussian exp(-r^2 / (2 sigma^2)).
  static double width(double drag_area, double way);

 private:
  TurbulentWaves waves_;
  std::vector<std::vector<double>> ways_;  ///< of each body: its path's length up to each sample [m]
};

}  // namespace ft::inline solvers

// A mat as a grid of vertical springs without shear (O'Brien, Zordan & Hodgins 2000, section 4): every piece of the
// body that faces down and has sunk in by d is pushed up by its share of
//   (k d + k3 d^3 + c d')+ ,    c = damping + 2 zeta sqrt(k M)     (Kelvin-Voigt; it never pulls)
// Shares are of the area that faces down, so that k is of the body's whole underside sunk in evenly: for a character
// the samples are its soles. At rest it sinks by M g / k. Horizontal slip is beyond it.
#pragma once

#include "solvers/standins/standin.h"

namespace ft::inline solvers {

/// Reads position (of its top), heading, size (x and z), soft_edge, stiffness, stiffness_cubic, damping, damping_ratio.
class SpringGrid final : public StandIn {
 public:
  static Result<std::unique_ptr<StandIn>> make(const StandInSpec& spec);
  bool is_supporting() const override { return true; }
  bool reaches(const BodyState& body, double margin) const override;

 protected:
  StandInForce law(const BodyState& body) const override;

 private:
  using StandIn::StandIn;
  /// 1 above and below the mat, 0 beside it, in between within the soft edge.
  double cover(const Vec3& place) const;
};

}  // namespace ft::inline solvers

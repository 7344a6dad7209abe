// A spring that only pulls (a bungee cord, a leash), between a place in the world and a point of the body:
//   (k (l - L) + c l')+ while l > L,    c = damping + 2 zeta sqrt(k M)
#pragma once

#include "solvers/standins/standin.h"

namespace ft::inline solvers {

/// Reads position (in the world), anchor (on the body), length, stiffness, damping, damping_ratio.
class UnilateralSpring final : public StandIn {
 public:
  static Result<std::unique_ptr<StandIn>> make(const StandInSpec& spec);
  bool reaches(const BodyState& body, double margin) const override;

 protected:
  StandInForce law(const BodyState& body) const override;

 private:
  using StandIn::StandIn;
};

}  // namespace ft::inline solvers

// A mass that the body carries at a point (a vest, a backpack): it pulls with m (g - a), where a is the acceleration of
// that point, so that at rest it is its weight and in free fall nothing.
#pragma once

#include "solvers/standins/standin.h"

namespace ft::inline solvers {

/// Reads mass and anchor.
class CarriedWeight final : public StandIn {
 public:
  static Result<std::unique_ptr<StandIn>> make(const StandInSpec& spec);
  bool reaches(const BodyState&, double) const override { return true; }

 protected:
  StandInForce law(const BodyState& body) const override;

 private:
  using StandIn::StandIn;
};

}  // namespace ft::inline solvers

// Water below a level plane, at rest. On every piece of the body, by the share w of it that is below:
//   rho g V w upwards                                     buoyancy; V of pieces of the inside
//   -rho/2 (Cd w + Cs 4 w (1 - w)) A (n.v)+ v             drag of what faces the motion; the second part, the slam,
//   only
//                                                         where the surface is being entered
// A piece counts as a cube of its volume, or of its area's side, so that the waterline runs through smoothly.
// (O'Brien, Zordan & Hodgins 2000, section 4: the diver.)
#pragma once

#include "solvers/standins/standin.h"

namespace ft::inline solvers {

/// Reads position (of its surface), density, drag, slam.
class WaterPlane final : public StandIn {
 public:
  static Result<std::unique_ptr<StandIn>> make(const StandInSpec& spec);
  bool is_supporting() const override { return true; }
  bool reaches(const BodyState& body, double margin) const override;

 protected:
  StandInForce law(const BodyState& body) const override;

 private:
  using StandIn::StandIn;
};

}  // namespace ft::inline solvers

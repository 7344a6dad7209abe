// A damping volume with a recoil, whose constants were fitted to recorded forces (fit.h):
//   F = -w (C v + c2 |v| v + k (x - position)),   torque = -w c_r omega
// The recoil lets it turn a motion around, which damping alone never does.
#pragma once

#include "solvers/standins/damping_volume.h"

namespace ft::inline solvers {

/// Reads what a damping volume does, and stiffness. Its position is where the recoil is nothing.
class FittedField final : public DampingVolume {
 public:
  static Result<std::unique_ptr<StandIn>> make(const StandInSpec& spec);
  bool is_dissipative() const override { return false; }

 protected:
  StandInForce law(const BodyState& body) const override;

 private:
  using DampingVolume::DampingVolume;
};

}  // namespace ft::inline solvers

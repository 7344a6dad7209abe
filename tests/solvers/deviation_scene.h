// Clips and forces that deviations are tested with.
#pragma once

#include <gtest/gtest.h>

#include "solvers/standins/deviation.h"
#include "solvers/standins/registry.h"
#include "solvers/standins/rigid_flight.h"

namespace ft::test {

/// The basketball of O'Brien, Zordan & Hodgins 2000: a hollow sphere.
inline RigidMass ball_mass() {
  return {0.68, 2.0 / 3 * 0.68 * 0.121 * 0.121 * Mat3::Identity()};
}

/// A box all around that damps.
inline StandInSpec field(double damping) {
  StandInSpec spec;
  spec.name = "net", spec.kind = "damping";
  spec.size = Vec3::Constant(1e3);
  spec.damping = damping;
  return spec;
}

inline std::vector<std::unique_ptr<StandIn>> stand_ins(const std::vector<StandInSpec>& specs) {
  std::vector<std::unique_ptr<StandIn>> out;
  for (const StandInSpec& spec : specs) {
    auto made = make_stand_in(spec);
    if (!made) ADD_FAILURE() << made.error().text();
    if (made) out.push_back(std::move(*made));
  }
  return out;
}

/// A force that never changes.
class ConstantForce final : public StandIn {
 public:
  ConstantForce(const Vec3& force, const Vec3& torque, const StandInSpec& spec = {}) : StandIn(spec) {
    out_.wrench = {force, torque};
  }
  bool reaches(const BodyState&, double) const override { return true; }

 protected:
  StandInForce law(const BodyState&) const override { return out_; }

 private:
  StandInForce out_;
};

inline Deviation deviation(YieldingBody body, std::vector<std::unique_ptr<StandIn>> acting,
                           const DeviationSettings& settings = {}) {
  auto made = Deviation::make(std::move(body), std::move(acting), settings);
  if (!made) ADD_FAILURE() << made.error().text();
  return std::move(*made);
}

inline DeviationStep advance(const Deviation& deviation, DeviationState& state, double until) {
  auto step = deviation.advance(state, until);
  if (!step) ADD_FAILURE() << step.error().text();
  return step ? *step : DeviationStep{};
}

/// A body that is kept where it is.
inline YieldingBody still_body(const RigidMass& mass) {
  return {mass, [](double) { return RigidMotion(); }, {}};
}

inline YieldingBody flying_body(const RigidMotion& release, const RigidMass& mass, const Vec3& gravity) {
  return {mass, [flight = RigidFlight(release, mass, gravity)](double t) { return flight.at(t); }, {}};
}

}  // namespace ft::test

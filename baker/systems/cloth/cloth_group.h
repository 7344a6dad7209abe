// Cloths that may meet are solved together and feel each other, with all primaries that they may meet (meeting.h).
#pragma once

#include "baker/plan/plan.h"
#include "baker/systems/cloth/joint_body.h"
#include "solvers/cloth/cloth_solver.h"

namespace ft::inline baker {

class ClothGroup final : public SystemGroup {
 public:
  using SystemGroup::SystemGroup;

  ClothSetup setup;                        ///< make_solver() takes it
  std::shared_ptr<const JointBody> joint;  ///< setup's primary, where cloth meets several bodies; else null
  std::vector<std::size_t> bodies;         ///< the members of joint, into BakePlan::primaries; else empty

  std::string_view role() const override { return "cloth"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan& plan) const override;
  bool has_feasible_collider() const override { return true; }
  std::vector<ColliderSlice> slices(const BakePlan& plan, std::span<const std::string> taken) const override;
  void add_start(const BakePlan& plan, StartReport& report) const override;
  void add_room(const BakePlan& plan, RoomReport& report) const override;
  void add_certificate(const BakePlan& plan, const Solver& solver, const State& state,
                       FrameReport& report) const override;

 private:
  std::shared_ptr<FeasiblePoses> poses_;  ///< of the setup, once the solver has that
};

}  // namespace ft::inline baker

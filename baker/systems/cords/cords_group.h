// All cords of one primary, which is their prop: one system in lock step. Cloth and cords do not feel each other.
#pragma once

#include "baker/plan/plan.h"
#include "solvers/lockstep/lockstep_solver.h"

namespace ft::inline baker {

class CordsGroup final : public SystemGroup {
 public:
  using SystemGroup::SystemGroup;

  LockstepSetup setup;

  std::string_view role() const override { return "cords"; }
  Result<std::unique_ptr<Solver>> make_solver() override { return make_lockstep_solver(setup); }
  std::vector<std::string> lines(const BakePlan& plan) const override;
};

}  // namespace ft::inline baker

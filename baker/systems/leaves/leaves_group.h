// One [leaves.NAME] in a plan: its leaves as instances of one shape.
#pragma once

#include "baker/plan/plan.h"
#include "baker/systems/leaves/leaves_spec.h"
#include "solvers/leaves/leaves_setup.h"

namespace ft::inline baker {

class LeavesGroup final : public SystemGroup {
 public:
  using SystemGroup::SystemGroup;

  LeavesSetup setup;
  std::vector<std::size_t> meets;  ///< primaries, into BakePlan::primaries
  Box around;                      ///< all leaves at the start [m]

  Box start() const override { return around; }
  std::string_view role() const override { return "leaves"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan& plan) const override;
  std::vector<ColliderSlice> slices(const BakePlan& plan, std::span<const std::string> taken) const override;
};

/// Errors say where; notes go into the plan.
Result<std::unique_ptr<LeavesGroup>> plan_leaves(const Shot& shot, const LeavesSpec& spec, std::size_t primary,
                                                 BakePlan& plan);

}  // namespace ft::inline baker

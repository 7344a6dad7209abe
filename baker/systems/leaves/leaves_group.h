// One [leaves.NAME] in a plan: its leaves as instances of one shape; those that start near the camera as a group of
// their own, which bends and is a mesh. Leaves do not meet one another, so nothing is lost between the two.
#pragma once

#include "baker/plan/drawn_group.h"
#include "baker/plan/plan.h"
#include "baker/systems/leaves/leaves_spec.h"
#include "solvers/leaves/leaves_setup.h"

namespace ft::inline baker {

class LeavesGroup final : public DrawnGroup {
 public:
  using DrawnGroup::DrawnGroup;

  LeavesSetup setup;

  std::string_view role() const override { return "leaves"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan& plan) const override;
};

/// Those that are far and those that are near, where there are any. Errors say where; notes go into the plan.
Result<std::vector<std::unique_ptr<LeavesGroup>>> plan_leaves(const Shot& shot, const LeavesSpec& spec,
                                                              std::size_t primary, BakePlan& plan);

}  // namespace ft::inline baker

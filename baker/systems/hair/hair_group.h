// One [hair.NAME] in a plan: its strands as curves.
#pragma once

#include "baker/plan/drawn_group.h"
#include "baker/plan/plan.h"
#include "baker/systems/hair/hair_spec.h"
#include "solvers/hair/hair_solver.h"

namespace ft::inline baker {

class HairGroup final : public DrawnGroup {
 public:
  using DrawnGroup::DrawnGroup;

  std::unique_ptr<HairSolver> solver;  ///< until make_solver()
  bool is_crowd = true;                ///< whether strands feel one another
  double mass = 0;                     ///< kg

  std::string_view role() const override { return "hair"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan& plan) const override;
};

/// What the shot says of a solver's setup, all but what it meets. Errors say where; notes go into the plan.
Result<HairSetup> hair_setup(const Shot& shot, const HairSpec& spec, std::size_t primary,
                             std::span<const std::size_t> meets, BakePlan& plan);

/// Errors say where; notes go into the plan.
Result<std::unique_ptr<HairGroup>> plan_hair(const Shot& shot, const HairSpec& spec, std::size_t primary,
                                             BakePlan& plan);

}  // namespace ft::inline baker

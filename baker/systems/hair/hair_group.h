// One [hair.NAME] in a plan: its strands as curves.
#pragma once

#include "baker/plan/plan.h"
#include "baker/systems/hair/hair_spec.h"
#include "solvers/hair/hair_setup.h"

namespace ft::inline baker {

class HairGroup final : public SystemGroup {
 public:
  using SystemGroup::SystemGroup;

  HairSetup setup;
  std::vector<std::size_t> meets;  ///< primaries, into BakePlan::primaries
  Box around;                      ///< all strands at the start [m]

  Box start() const override { return around; }
  std::string_view role() const override { return "hair"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan& plan) const override;
  std::vector<ColliderSlice> slices(const BakePlan& plan, std::span<const std::string> taken) const override;
};

/// Errors say where; notes go into the plan.
Result<std::unique_ptr<HairGroup>> plan_hair(const Shot& shot, const HairSpec& spec, std::size_t primary,
                                             BakePlan& plan);

}  // namespace ft::inline baker

// One [water.NAME] in a plan: its surface as a mesh, its droplets as points, and the primaries that float in it.
#pragma once

#include "baker/plan/drawn_group.h"
#include "baker/plan/plan.h"
#include "baker/systems/water/water_spec.h"
#include "solvers/water/water_solver.h"

namespace ft::inline baker {

class WaterGroup final : public DrawnGroup {
 public:
  using DrawnGroup::DrawnGroup;

  std::unique_ptr<WaterSolver> solver;  ///< until make_solver()
  std::string model;                    ///< "shallow", "pond" or "paper"
  double depth = 0;                     ///< of still water at its deepest [m]
  double volume = 0;                    ///< m3
  WaterCost cost;                       ///< of a frame
  WaterGrid grid;
  std::vector<std::size_t> floats;  ///< primaries that it moves, into BakePlan::primaries

  /// What floats, too.
  std::vector<ColliderSlice> slices(const BakePlan& plan, std::span<const std::string> taken) const override;
  std::string_view role() const override { return "water"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan& plan) const override;
};

/// Errors say where; notes go into the plan.
Result<std::unique_ptr<WaterGroup>> plan_water(const Shot& shot, const WaterSpec& spec, std::size_t primary,
                                               BakePlan& plan);

}  // namespace ft::inline baker

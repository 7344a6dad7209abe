#include "baker/systems/leaves/leaves_group.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/located.h"
#include "baker/plan/meets.h"
#include "baker/systems/interface/plan_common.h"
#include "baker/systems/leaves/scatter.h"
#include "io/shot/words.h"
#include "solvers/leaves/leaf_sleep.h"
#include "solvers/leaves/leaves_solver.h"

namespace ft::inline baker {
namespace {

/// What they lie on and what comes by.
Status add_bodies(const Shot& shot, const LeavesSpec& spec, BakePlan& plan, LeavesGroup& group) {
  const auto meets = meets_of(spec.meets, spec.on, plan.primaries);
  if (!meets) return meets.error();
  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    const PrimaryPlan& primary = plan.primaries[p];
    if ((*meets)[p] == 0 && primary.name != spec.on) continue;
    if (const std::string why = why_alone(plan.shot(), primary); !why.empty()) {
      plan.notes.push_back(fmt::format("{} do not meet \"{}\": {}", spec.owner(), primary.name, why));
      continue;
    }
    group.meets.push_back(p);
    const auto own = std::find_if(shot.primaries.begin(), shot.primaries.end(),
                                  [&](const PrimarySpec& s) { return s.name == primary.name; });
    if (own != shot.primaries.end() && own->shape == k_ground)
      group.setup.grounds.push_back({own->position.y(), spec.friction});
    else
      group.setup.bodies.push_back({primary.name, primary.trajectory, spec.friction, stands_still(shot, primary)});
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<LeavesGroup>> plan_leaves(const Shot& shot, const LeavesSpec& spec, std::size_t primary,
                                                 BakePlan& plan) {
  auto group = std::make_unique<LeavesGroup>(primary);
  LeavesSetup& setup = group->setup;
  setup.name = spec.name;
  take_from_shot(shot, plan.wind, setup);
  setup.seed = static_cast<std::uint64_t>(spec.seed);
  setup.mass_variation = spec.variation;
  auto prototype = leaf_prototype(spec);
  if (!prototype) return located(prototype.error(), shot, spec.owner());
  auto leaves = scatter(spec, *prototype);
  if (!leaves) return located(leaves.error(), shot, spec.owner());
  setup.prototypes.push_back(std::move(*prototype));
  setup.leaves = std::move(*leaves);
  for (const Leaf& leaf : setup.leaves) group->around.include(leaf.position);
  if (const Status added = add_bodies(shot, spec, plan, *group); !added)
    return located(added.error(), shot, spec.owner());
  SystemOutput output;
  output.primary = primary;
  output.shape = std::make_shared<const SystemShape>(instances_of(setup));
  group->outputs.push_back(std::move(output));
  return group;
}

Result<std::unique_ptr<Solver>> LeavesGroup::make_solver() {
  auto solver = LeavesSolver::make(std::move(setup));
  if (!solver) return solver.error();
  return std::unique_ptr<Solver>(std::move(*solver));
}

std::vector<std::string> LeavesGroup::lines(const BakePlan& plan) const {
  const LeafPrototype& leaf = setup.prototypes.at(0);
  const auto lying = std::count_if(setup.leaves.begin(), setup.leaves.end(), [](const Leaf& l) { return l.asleep; });
  std::vector<std::string> met;
  for (const std::size_t p : meets) met.push_back(in_quotes(plan.primaries[p].name));
  double friction = 0.5;
  for (const LeafGround& ground : setup.grounds) friction = ground.friction;
  return {
      fmt::format("leaves \"{}\" on \"{}\": {}, of which {} lie, with {} vertices each and {:.2g} g; those that lie "
                  "are lifted by winds from {:.2g} m/s on; they meet {}",
                  setup.name, plan.primaries[primary].name, setup.leaves.size(), lying, leaf.positions.size(),
                  1e3 * leaf.mass_per_area * shape_of(leaf).area,
                  lift_off_speed(leaf, 1, friction, setup.gravity.norm(), setup.air_density), joined(met))};
}

/// All of them are met as they are drawn.
std::vector<ColliderSlice> LeavesGroup::slices(const BakePlan& plan, std::span<const std::string>) const {
  std::vector<ColliderSlice> out;
  for (const std::size_t p : meets)
    out.push_back({.primary = p, .name = plan.primaries[p].name, .fixed = true, .vertices = {}, .triangles = {}});
  return out;
}

}  // namespace ft::inline baker

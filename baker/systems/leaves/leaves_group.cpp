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
void add_bodies(const Shot& shot, const LeavesSpec& spec, const BakePlan& plan, LeavesGroup& group) {
  for (const std::size_t p : group.meets) {
    const PrimaryPlan& primary = plan.primaries[p];
    const auto own = std::find_if(shot.primaries.begin(), shot.primaries.end(),
                                  [&](const PrimarySpec& s) { return s.name == primary.name; });
    if (primary.flow)
      group.setup.waters.push_back({primary.name, primary.trajectory, primary.flow});
    else if (own != shot.primaries.end() && own->shape == k_ground)
      group.setup.grounds.push_back({own->position.y(), spec.friction, primary.name});
    else
      group.setup.bodies.push_back({primary.name, primary.trajectory, spec.friction, stands_still(shot, primary)});
  }
}

}  // namespace

Result<std::vector<std::unique_ptr<LeavesGroup>>> plan_leaves(const Shot& shot, const LeavesSpec& spec,
                                                              std::size_t primary, BakePlan& plan) {
  auto prototype = leaf_prototype(spec);
  if (!prototype) return located(prototype.error(), shot, spec.owner());
  auto leaves = scatter(spec, *prototype);
  if (!leaves) return located(leaves.error(), shot, spec.owner());
  const auto first_near = std::stable_partition(leaves->begin(), leaves->end(), [&](const Leaf& leaf) {
    return !(spec.near > 0) || (leaf.position - spec.camera).norm() > spec.near;
  });
  if (spec.near > 0 && first_near == leaves->end())
    plan.notes.push_back(
        fmt::format("{}: none of them starts within {} m of its camera: none bends", spec.owner(), spec.near));
  std::vector<std::size_t> meets;
  if (const Status found = find_met(spec, spec.meets, plan, meets); !found)
    return located(found.error(), shot, spec.owner());
  const auto liquid = std::ranges::find_if(meets, [&](std::size_t p) { return plan.primaries[p].flow != nullptr; });
  if (liquid != meets.end())
    plan.notes.push_back(
        fmt::format("{} do not move \"{}\" back, pass through each other on it, and are as light after "
                    "it as before; beyond its rim they float on as if it went on",
                    spec.owner(), plan.primaries[*liquid].name));
  plan.notes.push_back(spec.owner() + ": forces are those of awake leaves; what sleeps is recorded as weightless");
  std::vector<std::unique_ptr<LeavesGroup>> out;
  for (const bool near : {false, true}) {
    const std::span<const Leaf> own =
        near ? std::span<const Leaf>(first_near, leaves->end()) : std::span<const Leaf>(leaves->begin(), first_near);
    if (own.empty()) continue;
    auto group = std::make_unique<LeavesGroup>(primary);
    LeavesSetup& setup = group->setup;
    setup.name = near ? spec.near_name() : spec.name;
    take_from_shot(shot, plan.wind, setup);
    setup.seed = static_cast<std::uint64_t>(spec.seed);
    setup.mass_variation = spec.variation;
    if (near) setup.bending = spec.bending;
    setup.prototypes.push_back(*prototype);
    setup.leaves.assign(own.begin(), own.end());
    for (const Leaf& leaf : setup.leaves) group->around.include(leaf.position);
    group->meets = meets;
    add_bodies(shot, spec, plan, *group);
    SystemOutput output;
    output.primary = primary;
    if (near)
      output.mesh = std::make_shared<const Mesh>(mesh_of(setup));
    else
      output.shape = std::make_shared<const SystemShape>(instances_of(setup));
    group->outputs.push_back(std::move(output));
    out.push_back(std::move(group));
  }
  return out;
}

Result<std::unique_ptr<Solver>> LeavesGroup::make_solver() {
  auto solver = LeavesSolver::make(std::move(setup));
  if (!solver) return solver.error();
  return std::unique_ptr<Solver>(std::move(*solver));
}

std::vector<std::string> LeavesGroup::lines(const BakePlan& plan) const {
  const LeafPrototype& leaf = setup.prototypes.at(0);
  const auto lying = std::count_if(setup.leaves.begin(), setup.leaves.end(), [](const Leaf& l) { return l.asleep; });
  double friction = 0.5;
  for (const LeafGround& ground : setup.grounds) friction = ground.friction;
  return {fmt::format(
      "leaves \"{}\" on \"{}\": {}{}, of which {} lie, with {} vertices each and {:.2g} g; those that lie "
      "are lifted by winds from {:.2g} m/s on; they meet {}",
      setup.name, plan.primaries[primary].name, setup.leaves.size(), setup.bending > 0 ? " that bend, as a mesh" : "",
      lying, leaf.positions.size(), 1e3 * leaf.mass_per_area * shape_of(leaf).area,
      lift_off_speed(leaf, 1, friction, setup.gravity.norm(), setup.air_density), met_names(plan))};
}

}  // namespace ft::inline baker

#include "baker/systems/hair/hair_group.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/located.h"
#include "baker/plan/meets.h"
#include "baker/systems/interface/plan_common.h"
#include "io/hair/guides.h"
#include "io/hair/resample.h"
#include "io/shot/words.h"
#include "solvers/hair/hair_solver.h"

namespace ft::inline baker {
namespace {

/// `count` of so many, evenly.
std::vector<std::size_t> evenly(std::size_t all, int count) {
  const std::size_t wanted = count > 0 ? std::min(all, at(count)) : all;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < wanted; ++k) out.push_back(k * all / wanted);
  return out;
}

Status add_strands(const HairSpec& spec, const Trajectory& scalp, BakePlan& plan, HairSetup& setup) {
  const std::vector<Vec3> bind = bind_pose_of(scalp);
  std::vector<Vec3> there = bind;  // as the file has it
  for (Vec3& p : there) p -= spec.position;
  const auto guides = read_guides(spec.guides, spec.scale, there);
  if (!guides) return guides.error();
  for (const std::string& note : guides->notes) plan.notes.push_back(spec.owner() + ": " + note);
  for (const std::size_t k : evenly(guides->strands.size(), spec.count)) {
    HairStrand strand;
    strand.id = k;
    strand.positions = resampled(guides->strands[k], spec.vertices);
    for (Vec3& p : strand.positions) p += spec.position;
    strand.width = guides->widths.empty() ? spec.width : guides->widths[k];
    // Held to where it leaves the band; what ends in it, whole.
    for (std::size_t i = 0; i < strand.positions.size(); ++i)
      if ((strand.positions[i] - spec.tie).norm() < spec.tie_radius) strand.held = static_cast<int>(i) + 1;
    setup.strands.push_back(std::move(strand));
  }
  return {};
}

Status add_bodies(const HairSpec& spec, BakePlan& plan, HairGroup& group) {
  const auto meets = meets_of(spec.meets, spec.on, plan.primaries);
  if (!meets) return meets.error();
  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    const PrimaryPlan& primary = plan.primaries[p];
    if ((*meets)[p] == 0 && primary.name != spec.on) continue;
    if (const std::string why = why_alone(plan.shot(), primary); !why.empty()) {
      plan.notes.push_back(fmt::format("{} does not meet \"{}\": {}", spec.owner(), primary.name, why));
      continue;
    }
    group.meets.push_back(p);
    group.setup.bodies.push_back(
        {primary.name, primary.trajectory, 1, has_sheets(primary.trajectory->surface().parts)});
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<HairGroup>> plan_hair(const Shot& shot, const HairSpec& spec, std::size_t primary,
                                             BakePlan& plan) {
  auto group = std::make_unique<HairGroup>(primary);
  HairSetup& setup = group->setup;
  setup.name = spec.name;
  take_from_shot(shot, plan.wind, setup);
  setup.material.radius = spec.radius;
  setup.material.stiffness = spec.stiffness;
  setup.material.damping = spec.damping;
  setup.material.drag = spec.drag;
  setup.material.air_drag = spec.air_drag;
  setup.material.friction = spec.friction;
  setup.material.thickness = spec.thickness;
  setup.scalp = plan.primaries[primary].trajectory;
  for (const Status& done : {add_strands(spec, *setup.scalp, plan, setup), add_bodies(spec, plan, *group)})
    if (!done) return located(done.error(), shot, spec.owner());
  for (const HairStrand& strand : setup.strands)
    for (const Vec3& p : strand.positions) group->around.include(setup.scalp->bind_to_start() * p);
  SystemOutput output;
  output.primary = primary;
  output.shape = std::make_shared<const SystemShape>(curves_of(setup));
  group->outputs.push_back(std::move(output));
  return group;
}

Result<std::unique_ptr<Solver>> HairGroup::make_solver() {
  auto solver = HairSolver::make(std::move(setup));
  if (!solver) return solver.error();
  return std::unique_ptr<Solver>(std::move(*solver));
}

std::vector<std::string> HairGroup::lines(const BakePlan& plan) const {
  std::vector<std::string> met;
  for (const std::size_t p : meets) met.push_back(in_quotes(plan.primaries[p].name));
  double length = 0, longest = 0;
  for (const HairStrand& strand : setup.strands) {
    const double own = length_of(strand.positions);
    length += own / static_cast<double>(setup.strands.size());
    longest = std::max(longest, own);
  }
  return {fmt::format(
      "hair \"{}\" on \"{}\": {} strands of {} vertices, {:.0f} mm long in the mean and {:.0f} at most; "
      "it meets {}",
      setup.name, plan.primaries[primary].name, setup.strands.size(),
      setup.strands.empty() ? 0 : setup.strands[0].positions.size(), 1e3 * length, 1e3 * longest, joined(met))};
}

/// All of them are met as they are drawn.
std::vector<ColliderSlice> HairGroup::slices(const BakePlan& plan, std::span<const std::string>) const {
  std::vector<ColliderSlice> out;
  for (const std::size_t p : meets)
    out.push_back({.primary = p, .name = plan.primaries[p].name, .fixed = true, .vertices = {}, .triangles = {}});
  return out;
}

}  // namespace ft::inline baker

#include "baker/systems/hair/hair_group.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/located.h"
#include "baker/systems/interface/plan_common.h"
#include "io/hair/guides.h"
#include "io/hair/resample.h"

namespace ft::inline baker {
namespace {

/// Roots that are farther from the surface are a note [m].
constexpr double k_root_off = 2e-3;

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

/// What differs from what one would think: a note each.
void add_notes(const HairSpec& spec, std::size_t scalp, const HairGroup& group, BakePlan& plan) {
  const auto note = [&](const std::string& text) { plan.notes.push_back(spec.owner() + ": " + text); };
  const PrimaryPlan& primary = plan.primaries[scalp];
  const HairSolver& solver = *group.solver;
  for (const std::size_t p : group.meets)
    if (has_sheets(plan.primaries[p].trajectory->surface().parts))
      note(
          fmt::format("vertices stay on their side of \"{}\", but its rims and folds may cut through between them; "
                      "check counts where",
                      plan.primaries[p].name));
  const auto stiff = solver.stiffened();
  const auto stiffer = std::count_if(stiff.begin(), stiff.end(), [](double factor) { return factor > 1; });
  if (stiffer > 0)
    note(
        fmt::format("{} of {} strands could not stand as they are combed, or grow beside one that could not: they are "
                    "stiffer, up to {:.2g} times",
                    stiffer, stiff.size(), *std::max_element(stiff.begin(), stiff.end())));
  if (const CombedInside inside = solver.combed_inside(); inside.vertices > 0)
    note(fmt::format("{} vertices are combed up to {:.1f} mm inside of what it meets, and may stay as deep",
                     inside.vertices, 1e3 * inside.deepest));
  if (solver.farthest_root() > k_root_off)
    note(
        fmt::format("roots are up to {:.1f} mm off the surface, and keep that distance", 1e3 * solver.farthest_root()));
  for (const Teleport& jump : primary.scan.teleports)
    note(fmt::format("\"{}\" jumps into frame {}: strands are dragged along", primary.name, jump.frame));
}

}  // namespace

Result<HairSetup> hair_setup(const Shot& shot, const HairSpec& spec, std::size_t primary, BakePlan& plan) {
  HairSetup setup;
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
  if (const Status added = add_strands(spec, *setup.scalp, plan, setup); !added)
    return located(added.error(), shot, spec.owner());
  return setup;
}

Result<std::unique_ptr<HairGroup>> plan_hair(const Shot& shot, const HairSpec& spec, std::size_t primary,
                                             BakePlan& plan) {
  auto group = std::make_unique<HairGroup>(primary);
  auto setup = hair_setup(shot, spec, primary, plan);
  if (!setup) return setup.error();
  if (const Status found = find_met(spec, spec.meets, plan, group->meets); !found)
    return located(found.error(), shot, spec.owner());
  for (const std::size_t p : group->meets) {
    const PrimaryPlan& met = plan.primaries[p];
    setup->bodies.push_back({met.name, met.trajectory, 1, has_sheets(met.trajectory->surface().parts)});
  }
  for (const HairStrand& strand : setup->strands)
    for (const Vec3& p : strand.positions) group->around.include(setup->scalp->bind_to_start() * p);
  SystemOutput output;
  output.primary = primary;
  output.shape = std::make_shared<const SystemShape>(curves_of(*setup));
  group->outputs.push_back(std::move(output));
  auto solver = HairSolver::make(std::move(*setup));
  if (!solver) return located(solver.error(), shot, spec.owner());
  group->solver = std::move(*solver);
  add_notes(spec, primary, *group, plan);
  return group;
}

Result<std::unique_ptr<Solver>> HairGroup::make_solver() {
  return std::unique_ptr<Solver>(std::move(solver));
}

std::vector<std::string> HairGroup::lines(const BakePlan& plan) const {
  const CurveSet& curves = outputs.at(0).shape->curves;
  double length = 0, longest = 0;
  for (int s = 0; s < curves.curve_count(); ++s) {
    const auto vertices = at(curves.vertices_per_curve[at(s)]);
    const double own = length_of(std::span(curves.rest).subspan(at(s) * vertices, vertices));
    length += own / curves.curve_count();
    longest = std::max(longest, own);
  }
  return {
      fmt::format("hair \"{}\" on \"{}\": {} strands of {} vertices, {:.0f} mm long in the mean and {:.0f} at most; "
                  "it meets {}; strands do not meet one another",
                  outputs[0].name(), plan.primaries[primary].name, curves.curve_count(),
                  curves.vertices_per_curve.at(0), 1e3 * length, 1e3 * longest, met_names(plan))};
}

}  // namespace ft::inline baker

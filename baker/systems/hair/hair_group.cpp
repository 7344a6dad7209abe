#include "baker/systems/hair/hair_group.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/located.h"
#include "baker/systems/hair/hair_source.h"
#include "baker/systems/hair/strands.h"
#include "baker/systems/interface/plan_common.h"
#include "io/hair/resample.h"

namespace ft::inline baker {
namespace {

/// Roots that are farther from the surface are a note [m].
constexpr double k_root_off = 2e-3;

/// What differs from what one would think: a note each.
void add_notes(const HairSpec& spec, const HairGroup& group, BakePlan& plan) {
  const auto note = [&](const std::string& text) { plan.notes.push_back(spec.owner() + ": " + text); };
  const HairSolver& solver = *group.solver;
  for (const std::size_t p : group.meets)
    if (spec.tie_radius > 0 && has_sheets(plan.primaries[p].trajectory->surface().parts))
      note(fmt::format("\"{}\" may go through what is tied, which stays with its root: check does not count it",
                       plan.primaries[p].name));
  const auto stiff = solver.stiffened();
  const auto stiffer = std::count_if(stiff.begin(), stiff.end(), [](double factor) { return factor > 1; });
  if (stiffer > 0)
    note(
        fmt::format("{} of {} strands could not stand as they are combed, or grow beside one that could not: they are "
                    "stiffer, up to {:.2g} times",
                    stiffer, stiff.size(), *std::max_element(stiff.begin(), stiff.end())));
  if (const CombedInside inside = solver.combed_inside(); inside.vertices + inside.segments > 0)
    note(fmt::format(
        "{} vertices are combed up to {:.1f} mm inside of what it meets, and {} segments between vertices cut "
        "through it: they may stay so",
        inside.vertices, 1e3 * inside.deepest, inside.segments));
  if (const int through = solver.combed_through(); through > 0)
    note(fmt::format("{} segments are combed through a garment: they may stay so", through));
  if (solver.farthest_root() > k_root_off)
    note(
        fmt::format("roots are up to {:.1f} mm off the surface, and keep that distance", 1e3 * solver.farthest_root()));
}

}  // namespace

Result<HairSetup> hair_setup(const Shot& shot, const HairSpec& spec, std::size_t primary,
                             std::span<const std::size_t> meets, BakePlan& plan) {
  HairSetup setup;
  setup.name = spec.name;
  take_from_shot(shot, plan.wind, setup);
  setup.material.radius = spec.radius;
  setup.material.stiffness = spec.stiffness;
  setup.material.damping = spec.damping;
  setup.material.drag = spec.drag;
  setup.material.air_drag = spec.air_drag;
  setup.material.friction = spec.friction;
  setup.material.pressure = spec.pressure;
  setup.material.mutual_drag = spec.mutual_drag;
  setup.material.thickness = spec.thickness;
  setup.hairs = spec.hairs;
  setup.scalp = plan.primaries[primary].trajectory;
  for (const Teleport& jump : plan.primaries[primary].scan.teleports) setup.teleports.push_back(jump.frame);
  for (const std::size_t p : meets) {
    const PrimaryPlan& met = plan.primaries[p];
    setup.bodies.push_back({met.name, met.trajectory, 1, has_sheets(met.trajectory->surface().parts)});
  }
  auto source = hair_source(spec, *setup.scalp, setup.bodies);
  if (!source) return located(source.error(), shot, spec.owner());
  for (const std::string& note : source->notes) plan.notes.push_back(spec.owner() + ": " + note);
  setup.strands = std::move(source->strands);
  setup.ridden = std::move(source->ridden);
  setup.ridden.name = spec.name + "_mesh";
  setup.riders = std::move(source->riders);
  if (spec.strands > 0)
    setup.between = strands_between(
        {spec.strands, spec.clumping, spec.length_variation, spec.width, static_cast<std::uint64_t>(spec.seed_number)},
        setup.strands, *setup.scalp);
  return setup;
}

Result<std::unique_ptr<HairGroup>> plan_hair(const Shot& shot, const HairSpec& spec, std::size_t primary,
                                             BakePlan& plan) {
  auto group = std::make_unique<HairGroup>(primary);
  if (const Status found = find_met(spec, spec.meets, plan, group->meets); !found)
    return located(found.error(), shot, spec.owner());
  auto setup = hair_setup(shot, spec, primary, group->meets, plan);
  if (!setup) return setup.error();
  for (const HairStrand& strand : setup->strands)
    for (const Vec3& p : strand.positions) group->around.include(setup->scalp->bind_to_start() * p);
  const auto add_output = [&](SystemShape shape) {
    SystemOutput& output = group->outputs.emplace_back();
    output.primary = primary;
    output.shape = std::make_shared<const SystemShape>(std::move(shape));
  };
  group->is_crowd = (spec.pressure > 0 || spec.mutual_drag > 0) && setup->strands.size() > 1;
  add_output(curves_of(*setup));
  if (!setup->between.empty()) add_output(curves_between(*setup));
  if (!setup->ridden.positions.empty()) {
    SystemOutput& output = group->outputs.emplace_back();
    output.primary = primary;
    output.mesh = std::make_shared<const Mesh>(setup->ridden);
  }
  auto solver = HairSolver::make(std::move(*setup));
  if (!solver) return located(solver.error(), shot, spec.owner());
  group->solver = std::move(*solver);
  group->mass = group->solver->mass();
  add_notes(spec, *group, plan);
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
  std::vector<std::string> out{fmt::format(
      "hair \"{}\" on \"{}\": {} strands of {} vertices, {:.0f} mm long in the mean and {:.0f} at most; it meets {}; "
      "strands {}",
      outputs[0].name(), plan.primaries[primary].name, curves.curve_count(), curves.vertices_per_curve.at(0),
      1e3 * length, 1e3 * longest, met_names(plan),
      is_crowd ? "feel one another as a crowd, not strand by strand" : "do not feel one another")};
  out.push_back(fmt::format("  its forces are those of {:.3g} kg: key \"hairs\"", mass));
  for (std::size_t k = 1; k < outputs.size(); ++k)
    out.push_back(outputs[k].shape
                      ? fmt::format("  \"{}\": {} strands between them, which go with their guides and are not solved; "
                                    "their velocities are those of the guides",
                                    outputs[k].name(), outputs[k].shape->curves.curve_count())
                      : fmt::format("  \"{}\": {} vertices, which ride on the strands", outputs[k].name(),
                                    outputs[k].mesh->positions.size()));
  return out;
}

}  // namespace ft::inline baker

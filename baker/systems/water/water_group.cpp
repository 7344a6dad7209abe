#include "baker/systems/water/water_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/plan/located.h"
#include "baker/plan/meets.h"
#include "baker/systems/water/water_bed.h"
#include "baker/systems/water/water_model.h"
#include "io/shot/mesh_file.h"
#include "io/shot/patterns.h"
#include "io/shot/words.h"
#include "solvers/water/paper/paper_core.h"
#include "solvers/water/pond/pond_core.h"
#include "solvers/water/shallow/shallow_core.h"

namespace ft::inline baker {
namespace {

/// Cells along the longer side, where the shot names no size of them.
constexpr double k_cells = 256;
/// And no smaller than this [m].
constexpr double k_smallest_cell = 0.005;

/// Of water, kinematic [m2/s].
constexpr double k_viscosity = 1e-6;

/// More than any model takes.
constexpr std::size_t k_most_cells = 50'000'000;

/// Of the whole rectangle: cells are square and an even number, so that it may grow by a cell or two.
WaterGrid grid_of(const WaterSpec& spec) {
  WaterGrid out;
  out.cell = spec.cell > 0 ? spec.cell : std::max(k_smallest_cell, std::max(spec.size.x(), spec.size.z()) / k_cells);
  const auto cells = [&](double length) {
    return 2 * std::max(4, static_cast<int>(std::ceil(0.5 * length / out.cell - 1e-6)));
  };
  out.nx = cells(spec.size.x()), out.nz = cells(spec.size.z());
  out.origin = Vec2(spec.position.x() - 0.5 * out.cell * out.nx, spec.position.z() - 0.5 * out.cell * out.nz);
  return out;
}

/// What floats, where it is and how fast at the first frame.
Status find_floats(const WaterSpec& spec, BakePlan& plan, WaterGroup& group, std::vector<WaterFloat>& floats,
                   std::vector<std::pair<FloatingBody, RigidMotion>>& bodies) {
  std::vector<std::string> names;
  for (const PrimaryPlan& primary : plan.primaries) names.push_back(primary.name);
  const auto found = indices_like(spec.floats, names, "floats", "primary");
  if (!found) return found.error();
  for (const int p : *found) {
    const PrimaryPlan& primary = plan.primaries[at(p)];
    if (!primary.prop) return usage_error(in_quotes(primary.name) + " cannot float: it is no rigid prop");
    if (!(primary.prop->mass.mass > 0))
      return usage_error(in_quotes(primary.name) + " cannot float: its mass is missing");
    if (primary.prop->release > 0 && std::isfinite(primary.prop->release))
      plan.notes.push_back(fmt::format("{}: \"{}\" floats from the first frame on, whatever its release says",
                                       spec.owner(), primary.name));
    group.floats.push_back(at(p));
    floats.push_back({primary.name, primary.prop->surface});
    bodies.push_back(
        {{primary.name, primary.prop->surface, primary.prop->triangles, primary.prop->mass, spec.float_drag},
         primary.prop->track(0)});
  }
  return {};
}

using Floats = std::vector<std::pair<FloatingBody, RigidMotion>>;

/// What models of columns over a bed have in common.
template <class Setup, class Edge>
Setup columns_setup(const Shot& shot, const WaterSpec& spec, const WaterGrid& grid, std::vector<double> bed,
                    Floats floats, Edge wall, Edge open) {
  Setup out;
  out.name = spec.name;
  out.origin = grid.origin, out.cell = grid.cell, out.nx = grid.nx, out.nz = grid.nz;
  out.bed = bed.empty() ? std::vector<double>(grid.count(), spec.position.y() - spec.depth) : std::move(bed);
  out.level = spec.position.y();
  out.edges.fill(spec.edges == "wall" ? wall : open);
  if (spec.edges == "drain") out.depth = depths_that_stay(grid, out.bed, out.level);
  out.gravity = shot.solver.gravity.norm();
  out.manning = spec.roughness;
  out.seed = static_cast<std::uint64_t>(spec.seed);
  out.splash.on = spec.splash > 0;
  for (auto& [body, start] : floats) out.floats.push_back({std::move(body), start});
  return out;
}

ShallowSetup shallow_setup(const Shot& shot, const WaterSpec& spec, const WaterGrid& grid, std::vector<double> bed,
                           Floats floats) {
  auto out = columns_setup<ShallowSetup>(shot, spec, grid, std::move(bed), std::move(floats), ShallowEdge::k_wall,
                                         ShallowEdge::k_open);
  out.splash.share = std::min(1.0, out.splash.share * spec.splash);
  return out;
}

PaperSetup paper_setup(const Shot& shot, const WaterSpec& spec, const WaterGrid& grid, std::vector<double> bed,
                       Floats floats) {
  auto out = columns_setup<PaperSetup>(shot, spec, grid, std::move(bed), std::move(floats), PaperEdge::k_wall,
                                       PaperEdge::k_open);
  out.viscosity = k_viscosity;
  if (spec.splash > 0) out.splash.threshold /= spec.splash;
  return out;
}

PondSetup pond_setup(const Shot& shot, const WaterSpec& spec, const WaterGrid& grid, double depth, Floats floats) {
  PondSetup out;
  out.name = spec.name;
  out.corner = Vec3(grid.origin.x(), spec.position.y(), grid.origin.y());
  out.size_x = grid.cell * grid.nx, out.size_z = grid.cell * grid.nz, out.nx = grid.nx, out.nz = grid.nz;
  out.depth = depth;
  out.edges = spec.edges == "open" ? PondEdge::k_open : PondEdge::k_wall;
  out.gravity = shot.solver.gravity.norm();
  out.seed = static_cast<std::uint64_t>(spec.seed);
  out.splash.on = spec.splash > 0;
  out.splash.energy_share = std::min(1.0, out.splash.energy_share * spec.splash);
  out.splash.cavity_opening *= spec.cavity;
  out.wind = Vec2(shot.wind.velocity.x(), shot.wind.velocity.z());
  for (auto& [body, start] : floats) out.floats.push_back({std::move(body), start, 0.3});
  return out;
}

/// What goes through it: all that `meets` names but what floats, the ground, which is its own affair, and what jumps.
Status find_visitors(const Shot& shot, const WaterSpec& spec, BakePlan& plan, WaterGroup& group, WaterScene& scene) {
  const auto named = meets_of(spec.meets, {}, plan.primaries);
  if (!named) return named.error();
  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    const PrimaryPlan& body = plan.primaries[p];
    const auto own = std::ranges::find(shot.primaries, body.name, &PrimarySpec::name);
    if ((*named)[p] == 0 || (own != shot.primaries.end() && own->shape == k_ground) ||
        std::ranges::count(group.floats, p) > 0)
      continue;
    if (const std::string why = why_alone(shot, body); !why.empty()) {
      plan.notes.push_back(fmt::format("{} does not meet \"{}\": {}", spec.owner(), body.name, why));
      continue;
    }
    group.meets.push_back(p);
    if (has_sheets(body.trajectory->surface().parts)) {
      if (spec.bed.empty())
        plan.notes.push_back(
            fmt::format("{}: \"{}\" is a sheet without an inside, and pushes no water away", spec.owner(), body.name));
      continue;
    }
    std::vector<Vec3> start(at(body.trajectory->surface().vertex_count()));
    body.trajectory->sample(0, start);
    const Box box = bounds(start);
    if (const Vec3 size = box.hi - box.lo; size.x() > spec.size.x() && size.z() > spec.size.z())
      return usage_error(fmt::format("\"{}\" is {:.3g} x {:.3g} m, larger than the water of {:.3g} x {:.3g} m",
                                     body.name, size.x(), size.z(), spec.size.x(), spec.size.z()),
                         {}, "meets names what goes through it");
    scene.visitors.push_back({body.name, body.trajectory});
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<WaterGroup>> plan_water(const Shot& shot, const WaterSpec& spec, std::size_t primary,
                                               BakePlan& plan) {
  const auto place = [&](const Error& error) { return located(error, shot, spec.owner()); };
  const auto note = [&](const std::string& text) { plan.notes.push_back(spec.owner() + ": " + text); };
  auto group = std::make_unique<WaterGroup>(primary);
  WaterScene scene;
  scene.name = spec.name;
  scene.droplets = spec.splash > 0;
  scene.first_frame = shot.first_frame, scene.fps = shot.fps, scene.preroll_frames = shot.preroll;
  std::vector<std::pair<FloatingBody, RigidMotion>> bodies;
  if (const Status found = find_floats(spec, plan, *group, scene.floats, bodies); !found) return place(found.error());
  if (const Status found = find_visitors(shot, spec, plan, *group, scene); !found) return place(found.error());
  const WaterGrid grid = grid_of(spec);
  if (grid.count() > k_most_cells)
    return place(usage_error(fmt::format("{} x {} cells of {:.3g} m are more than {:.3g} millions", grid.nx, grid.nz,
                                         grid.cell, 1e-6 * double(k_most_cells)),
                             {}, "a larger cell, or none, which is chosen by the size"));
  std::vector<double> bed;
  double depth = spec.depth;
  if (!spec.bed.empty()) {
    auto mesh = read_obj(spec.bed);
    if (!mesh) return mesh.error();
    WaterBed under = bed_under(grid, mesh->positions, triangulate(*mesh));
    if (under.uncovered > 0)
      note(fmt::format("the bed does not reach under {} of {} cells: they are as high as its highest place",
                       under.uncovered, grid.count()));
    bed = std::move(under.height);
    depth = spec.position.y() - *std::ranges::min_element(bed);
  }
  const WaterAdvice advice = advise_water(std::max(depth, 1e-6), spec.size.x(), spec.size.z(), !bed.empty());
  group->model = spec.model.empty() ? advice.model : spec.model;
  if (spec.model.empty()) note(fmt::format("model = \"{}\": {}", advice.model, advice.reason));
  if (const std::string doubt = doubt_of_model(group->model, advice, depth); !doubt.empty()) note(doubt);
  for (const std::string& limit : limits_of_model(group->model, scene.floats.size())) note(limit);
  if (group->model == "pond" && spec.roughness != WaterSpec().roughness)
    note("roughness is not used: it is of the ground under shallow water");
  if (group->model != "pond" && spec.cavity != WaterSpec().cavity)
    note("cavity is not used: it is of cavities behind what dives into a pond");
  if (shot.preroll > 0) note("stands still during the pre-roll");

  auto core = group->model == "pond" ? pond_core(pond_setup(shot, spec, grid, depth, std::move(bodies)))
              : group->model == "paper"
                  ? paper_core(paper_setup(shot, spec, grid, std::move(bed), std::move(bodies)))
                  : shallow_core(shallow_setup(shot, spec, grid, std::move(bed), std::move(bodies)));
  if (!core) return place(core.error());
  group->grid = grid;
  group->depth = depth;
  group->around.include(Vec3(grid.origin.x(), spec.position.y() - depth, grid.origin.y()));
  group->around.include(
      Vec3(grid.origin.x() + grid.cell * grid.nx, spec.position.y(), grid.origin.y() + grid.cell * grid.nz));
  group->solver = std::make_unique<WaterSolver>(std::move(scene), std::move(*core));
  group->cost = group->solver->core().cost(1 / shot.fps);
  group->volume = group->solver->core().ledger(group->solver->initial_state()).total();
  SystemOutput& surface = group->outputs.emplace_back();
  surface.primary = primary;
  surface.mesh = std::make_shared<const Mesh>(group->solver->system_mesh(0));
  const auto scalars = group->solver->scalar_names(0);
  surface.scalars.assign(scalars.begin(), scalars.end());
  if (!(spec.splash > 0)) return group;
  SystemOutput& droplets = group->outputs.emplace_back();
  droplets.primary = primary;
  droplets.shape = std::make_shared<const SystemShape>(*group->solver->system_shape(1));
  return group;
}

std::vector<ColliderSlice> WaterGroup::slices(const BakePlan& plan, std::span<const std::string> taken) const {
  std::vector<ColliderSlice> out = DrawnGroup::slices(plan, taken);
  for (const std::size_t p : floats)
    out.push_back({.primary = p, .name = plan.primaries[p].name, .fixed = true, .vertices = {}, .triangles = {}});
  return out;
}

Result<std::unique_ptr<Solver>> WaterGroup::make_solver() {
  return std::unique_ptr<Solver>(std::move(solver));
}

std::vector<std::string> WaterGroup::lines(const BakePlan& plan) const {
  std::vector<std::string> out{fmt::format(
      "water \"{}\", {}: {} x {} cells of {:.3g} m, {:.3g} m deep at most, {:.4g} m3; through it go {}",
      outputs[0].name(),
      model == "pond"    ? "a pond"
      : model == "paper" ? "the paper's"
                         : "shallow",
      grid.nx, grid.nz, grid.cell, depth, volume, meets.empty() ? std::string("no bodies") : met_names(plan))};
  out.push_back(fmt::format("  about {:.0f} MB of memory, and {:.2g} s of one core for a calm frame", cost.bytes / 1e6,
                            cost.seconds));
  std::vector<std::string> moved;
  for (const std::size_t p : floats) moved.push_back(in_quotes(plan.primaries[p].name));
  if (!moved.empty()) out.push_back("  it moves, and is moved by, " + joined(moved));
  return out;
}

}  // namespace ft::inline baker

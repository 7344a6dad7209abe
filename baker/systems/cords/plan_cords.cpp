#include "baker/systems/cords/plan_cords.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/located.h"
#include "baker/plan/meets.h"
#include "baker/plan/quality.h"
#include "baker/systems/interface/plan_common.h"
#include "io/shot/mesh_file.h"
#include "io/shot/shot_values.h"
#include "io/shot/words.h"
#include "solvers/cords/generators.h"
#include "solvers/cords/tubes.h"

namespace ft::inline baker {
namespace {

// Of a preview.
constexpr int k_fewer_substeps = 4;        ///< times fewer substeps at least
constexpr double k_longer_cord_steps = 5;  ///< [1]
constexpr double k_looser_cords = 100;     ///< of what Newton leaves to move [1]

Result<CordSystem> cord_system(const CordsSpec& spec) {
  auto graph = cord_graph(spec);
  if (!graph) return graph.error();
  CordSystem out;
  out.name = spec.name;
  out.graph = std::move(*graph);
  static_cast<CordSettings&>(out) = spec;
  return out;
}

RigidProp rigid_prop(const Prop& prop, const RigidTrack& track, bool two_way) {
  RigidProp out;
  out.name = prop.name;
  out.surface = prop.surface;
  out.triangles = prop.triangles;
  out.mass = prop.mass;
  out.track = track;
  out.two_way = two_way;
  out.release_on_contact = prop.release_on_contact;
  // What has nothing to release it is free from the first frame.
  out.release = prop.release_on_contact || std::isfinite(prop.release) ? prop.release : 0;
  return out;
}

/// What `quality = "preview"` means for cords: longer steps.
void apply_quality(const Shot& shot, LockstepSetup& setup) {
  if (!is_preview(shot)) return;
  setup.longest_step *= k_longer_cord_steps;
  setup.settled *= k_looser_cords;
  setup.most_halvings = 0;
  setup.min_substeps = std::max(1, setup.min_substeps / k_fewer_substeps);
}

/// The other primaries that the cords of a group meet, each specs' own.
Status add_bodies(const Shot& shot, std::span<const CordsSpec* const> specs, BakePlan& plan, CordsGroup& group) {
  std::vector<std::vector<char>> meets;
  for (const CordsSpec* spec : specs) {
    auto own = meets_of(spec->meets, spec->on, plan.primaries);
    if (!own) return located(own.error(), shot, spec->owner());
    meets.push_back(std::move(*own));
  }
  const std::string& prop = plan.primaries[group.primary].name;
  std::vector<std::string> past;  // a two-way prop
  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    if (p == group.primary && group.setup.prop) continue;
    const PrimaryPlan& primary = plan.primaries[p];
    if (p != group.primary) past.push_back(in_quotes(primary.name));
    MetBody body{primary.name, primary.trajectory, stands_still(shot, primary), {}};
    for (const auto& of_spec : meets) body.met_by.push_back(of_spec[p]);
    if (std::count(body.met_by.begin(), body.met_by.end(), 1) == 0) continue;
    if (const std::string why = why_alone(plan.shot(), primary); !why.empty() && p != group.primary) {
      plan.notes.push_back(fmt::format("cords on \"{}\" do not meet \"{}\": {}", prop, primary.name, why));
      continue;
    }
    group.setup.bodies.push_back(std::move(body));
    group.bodies.push_back(p);
  }
  if (!group.setup.prop || !group.setup.prop->two_way || past.empty()) return {};
  plan.notes.push_back(
      fmt::format("\"{}\" goes where its cords let it (two-way) and does not meet {}", prop, joined(past)));
  if (!group.bodies.empty())
    plan.notes.push_back(fmt::format("cords on \"{}\" move that alone: all else that they meet goes its way", prop));
  return {};
}

}  // namespace

Result<CordGraph> cord_graph(const CordsSpec& s) {
  if (s.shape == "net") {
    NetMeasures net;
    net.columns = s.columns;
    net.rows = s.rows;
    net.radius_top = s.radius_top;
    net.radius_bottom = s.radius_bottom;
    net.length = s.length;
    net.pieces = s.points;
    net.centre = s.position;
    return diamond_net(net);
  }
  if (s.shape == "mesh") {
    auto mesh = read_obj(s.mesh);
    if (!mesh) return mesh.error();
    for (Vec3& p : mesh->positions) {
      p *= s.unit_scale;
      if (s.up == "z") p = Vec3(p.x(), p.z(), -p.y());
      p += s.position;
    }
    return cords_of_mesh(*mesh, s.held, s.points);
  }
  RopeMeasures line;
  line.from = s.position;
  line.to = s.to;
  line.pieces = s.points;
  line.hold_from = s.held == "start" || s.held == "both";
  line.hold_to = s.held == "end" || s.held == "both";
  if (s.shape == "knots") {
    line.knots = s.knots;
    line.knot_share = s.knot_mass / (s.mass - s.knots * s.knot_mass);
  }
  return rope(line);
}

Result<std::unique_ptr<CordsGroup>> cords_of(const Shot& shot, std::size_t p, BakePlan& plan) {
  const PrimaryPlan& primary = plan.primaries[p];
  auto group = std::make_unique<CordsGroup>(p);
  LockstepSetup& setup = group->setup;
  bool two_way = false;
  std::vector<const CordsSpec*> specs;
  for (const CordsSpec* one : specs_of<CordsSpec>(shot.secondaries)) {
    const CordsSpec& spec = *one;
    if (spec.on != primary.name) continue;
    auto system = cord_system(spec);
    if (!system) return located(system.error(), shot, spec.owner());
    Mesh mesh = CordTubes(system->graph, system->radius, spec.name).mesh();
    mesh.name = spec.name;
    SystemOutput output;
    output.primary = p;
    output.mesh = std::make_shared<const Mesh>(std::move(mesh));
    group->outputs.push_back(std::move(output));
    setup.cords.push_back(std::move(*system));
    specs.push_back(one);
    two_way = two_way || spec.coupling == "two-way";
  }
  if (setup.cords.empty()) return std::unique_ptr<CordsGroup>();
  const std::string where = shot.file.filename().string() + ": primary \"" + primary.name + "\"";
  const auto not_two_way = [&](const auto& s) { return s->on == primary.name && s->coupling != "two-way"; };
  if (two_way && std::any_of(shot.secondaries.begin(), shot.secondaries.end(), not_two_way))
    return usage_error("some of its secondaries are two-way and others are not", where,
                       "a primary that yields is followed by cords that are all two-way so far");
  CHECK(primary.prop);
  // What stands still needs no nodes of its own: it is met as other primaries are.
  if (two_way || !stands_still(shot, primary)) setup.prop = rigid_prop(*primary.prop, primary.track, two_way);
  if (const Status added = add_bodies(shot, specs, plan, *group); !added) return added.error();
  take_from_shot(shot, plan.wind, setup);
  apply_quality(shot, setup);
  return group;
}

}  // namespace ft::inline baker

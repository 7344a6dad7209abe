#include "baker/systems/cloth/plan_cloths.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "baker/plan/located.h"
#include "baker/systems/cloth/pins.h"
#include "baker/systems/cloth/vertex_maps.h"
#include "baker/systems/interface/plan_common.h"
#include "io/shot/garment_size.h"
#include "io/shot/mesh_file.h"
#include "io/shot/patterns.h"
#include "io/shot/shot_values.h"
#include "io/shot/weld.h"
#include "io/shot/words.h"
#include "solvers/cloth/embed/coarse_garment.h"

namespace ft::inline baker {

namespace {

/// Scale, axis and offset of the shot file -> metres, Y-up, the primary's bind pose.
void place_garment(Mesh& mesh, const ClothSpec& spec) {
  for (Vec3& p : mesh.positions) {
    p *= spec.unit_scale;
    if (spec.up == "z") p = Vec3(p.x(), p.z(), -p.y());
    p += spec.offset;
  }
}

/// Parts of a primary whose names are what one of the patterns says, ascending. key: "ignore".
Result<std::vector<int>> parts_like(const std::vector<std::string>& patterns, const std::string& key,
                                    const PrimaryPlan& primary) {
  std::vector<std::string> names;
  for (const SurfacePart& part : primary.trajectory->surface().parts) names.push_back(part.name);
  return indices_like(patterns, names, key, "part of " + in_quotes(primary.name));
}

/// ""hand_l", "hand_r" and 3 more".
std::string some_parts(std::span<const int> some, const PrimaryPlan& primary) {
  constexpr std::size_t k_named = 8;
  std::vector<std::string> names;
  for (const int part : some.first(std::min(k_named, some.size())))
    names.push_back(in_quotes(primary.trajectory->surface().parts[at(part)].name));
  return joined(names) + (some.size() > k_named ? fmt::format(" and {} more", some.size() - k_named) : "");
}

/// What the keys take out of the body, for all cloths of the primary and for each.
Status add_ignored(const Shot& shot, const PrimarySpec& spec, const PrimaryPlan& primary,
                   std::span<const ClothSpec* const> worn, ClothGroup& group, std::vector<std::string>& notes) {
  const std::size_t part_count = primary.trajectory->surface().parts.size();
  const auto note = [&](const std::string& who, const std::vector<int>& parts) {
    if (parts.empty()) return;
    notes.push_back(fmt::format("{} not meet {} of the {} parts of \"{}\": {}", who, parts.size(), part_count,
                                primary.name, some_parts(parts, primary)));
  };
  auto of_all = parts_like(spec.ignore, "ignore", primary);
  if (!of_all) return located(of_all.error(), shot, "primary " + in_quotes(spec.name));
  if (!worn.empty()) note("cloth does", *of_all);
  for (std::size_t g = 0; g < worn.size(); ++g) {
    auto own = parts_like(worn[g]->ignores, "ignores", primary);
    if (!own) return located(own.error(), shot, worn[g]->owner());
    note("cloth " + in_quotes(worn[g]->name) + " does", *own);
    std::set_union(of_all->begin(), of_all->end(), own->begin(), own->end(),
                   std::back_inserter(group.setup.garments[g].ignores));
  }
  return {};
}

/// Frames of the shot -> seconds from its first frame.
HoldSpan hold_span(const PinSpec& pin, const Shot& shot) {
  HoldSpan out;
  if (pin.from) out.from = (*pin.from - shot.first_frame) / shot.fps;
  if (pin.until) out.until = (*pin.until - shot.first_frame) / shot.fps;
  out.fade = pin.fade / shot.fps;
  return out;
}

/// A pin on vertices of the file -> on joined ones; the strongest weight counts.
ClothPin on_joined(const ClothPin& pin, std::span<const int> joined_of) {
  std::map<int, double> weight_of;
  for (std::size_t i = 0; i < pin.vertices.size(); ++i) {
    double& weight = weight_of[joined_of[static_cast<std::size_t>(pin.vertices[i])]];
    weight = std::max(weight, pin.weights.empty() ? 1.0 : pin.weights[i]);
  }
  ClothPin out;
  static_cast<ClothPinSettings&>(out) = pin;
  for (const auto& [vertex, weight] : weight_of) out.vertices.push_back(vertex), out.weights.push_back(weight);
  return out;
}

Status add_garment(const Shot& shot, const ClothSpec& spec, const PrimaryPlan& primary, ClothGroup& group,
                   std::vector<std::string>& notes) {
  const auto at_cloth = [&](const Error& error) { return located(error, shot, spec.owner()); };
  std::vector<std::string> mesh_notes;
  auto mesh = read_obj(spec.mesh, &mesh_notes);
  if (!mesh) return at_cloth(mesh.error());
  ClothGarment garment;
  SystemOutput output;
  garment.name = spec.name;
  mesh->name = spec.name;
  place_garment(*mesh, spec);
  garment.mesh = *mesh;
  output.mesh = std::make_shared<const Mesh>(std::move(*mesh));
  if (spec.weld > 0 && all_finite(output.mesh->positions)) {
    WeldedMesh welded = weld(*output.mesh, spec.weld);
    garment.mesh = std::move(welded.mesh);
    garment.mesh.name = spec.name;
    output.joined_of = std::move(welded.joined_of);
    output.in_file = std::move(welded.in_file);
    output.weld = spec.weld;
  }
  if (const Status checked = check_garment(garment.mesh, output.in_file); !checked) {
    Error error = at_cloth(checked.error());
    if (error.where.find(spec.mesh.filename().string()) == std::string::npos) error.where += ": " + spec.mesh.string();
    return error;
  }
  if (spec.faces == k_faces_triangles)
    output.mesh = std::make_shared<const Mesh>(with_triangles_of(*output.mesh, garment.mesh, output.in_file));
  for (const std::string& note : inspect_garment(garment.mesh, output.in_file).notes) mesh_notes.push_back(note);
  for (const std::string& note : mesh_notes) notes.push_back("cloth \"" + spec.name + "\": " + note);

  if (spec.rest == "pattern" || (spec.rest.empty() && !garment.mesh.stitches.empty())) {
    std::vector<std::string> pattern_notes;
    if (const Status cut = check_pattern(garment.mesh, spec.pattern_scale, pattern_notes, output.in_file); !cut)
      return at_cloth(cut.error());
    for (const std::string& note : pattern_notes) notes.push_back("cloth \"" + spec.name + "\": " + note);
    garment.pattern_scale = spec.pattern_scale;
  }
  static_cast<ClothSettings&>(garment) = spec;
  if (!garment.mesh.stitches.empty() && spec.sewing_time > shot.preroll / shot.fps)
    notes.push_back(fmt::format(
        "cloth \"{}\": its seams close {:.3g} s after the shot's first frame: sewing_time is longer than the pre-roll",
        spec.name, spec.sewing_time - shot.preroll / shot.fps));
  if (!garment.mesh.stitches.empty() && shot.preroll == 0)
    notes.push_back(fmt::format("cloth \"{}\" is sewn in the shot's first frames: there is no pre-roll", spec.name));

  const Fabric* fabric = find_fabric(spec.fabric);
  if (!fabric) return at_cloth(usage_error("fabric \"" + spec.fabric + "\" does not exist"));
  garment.fabric = *fabric;
  for (const auto& [key, value] : spec.fabric_overrides)
    if (!set_fabric_value(garment.fabric, key, value))
      return at_cloth(usage_error("fabric has no value \"" + key + "\""));

  auto maps = resolve_maps(spec.maps, *output.mesh);
  if (!maps) return at_cloth(maps.error());
  garment.maps =
      output.joined_of.empty() ? std::move(*maps) : on_joined(*maps, output.joined_of, garment.mesh.vertex_count());

  const Box cloth_box = bounds(garment.mesh.positions);
  Box body_box = bounds(bind_pose_of(*primary.trajectory));
  const std::string doubt = doubt_of_size(cloth_box.size().maxCoeff(), spec.unit_scale);
  if (!doubt.empty()) notes.push_back("cloth \"" + spec.name + "\" " + doubt);
  const double ratio = cloth_box.size().maxCoeff() / body_box.size().maxCoeff();
  if (doubt.empty() && (ratio > 10 || ratio < 0.01))
    notes.push_back(fmt::format("cloth \"{}\" is {:.3g} m in size on a body of {:.3g} m: is unit_scale right?",
                                spec.name, cloth_box.size().maxCoeff(), body_box.size().maxCoeff()));
  body_box.inflate(0.1 * body_box.size().maxCoeff());
  if (!cloth_box.overlaps(body_box))
    notes.push_back(fmt::format("cloth \"{}\" is nowhere near \"{}\" in the bind pose: are offset and up right?",
                                spec.name, primary.name));
  output.pattern_scale = garment.pattern_scale;
  group.setup.garments.push_back(std::move(garment));
  group.outputs.push_back(std::move(output));
  return {};
}

/// The pins of a garment of the group, once all garments are there: they may hold to any of them.
Status add_pins(const Shot& shot, const ClothSpec& spec, const PrimaryPlan& primary, ClothGroup& group, std::size_t own,
                std::vector<std::string>& notes) {
  auto& garments = group.setup.garments;
  const auto at_cloth = [&](const Error& error) { return located(error, shot, spec.owner()); };
  const SystemOutput& output = group.outputs[own];
  const auto body = bind_pose_of(*primary.trajectory);
  for (const PinSpec& pin_spec : spec.pins) {
    const auto target = std::find_if(garments.begin(), garments.end(),
                                     [&](const ClothGarment& garment) { return garment.name == pin_spec.to; });
    const bool to_world = pin_spec.to == k_pin_world, to_cloth = !pin_spec.to.empty() && !to_world;
    CHECK(!to_cloth || target != garments.end());  // the shot file was judged
    auto resolved = to_cloth ? resolve_pin(pin_spec, *output.mesh, target->mesh.positions, triangulate(target->mesh))
                             : resolve_pin(pin_spec, *output.mesh, body, primary.trajectory->surface().triangles);
    if (!resolved) return at_cloth(resolved.error());
    ClothPin pin = output.joined_of.empty() ? std::move(*resolved) : on_joined(*resolved, output.joined_of);
    pin.hold = hold_span(pin_spec, shot);
    pin.to_world = to_world;
    if (to_cloth) {
      pin.to = static_cast<int>(target - garments.begin());
      if (const Status held = check_anchor_points(garments, own, pin, notes); !held) return at_cloth(held.error());
    }
    garments[own].pins.push_back(std::move(pin));
  }
  return {};
}

void note_riding(const ClothGarment& garment, std::vector<std::string>& notes) {
  const std::optional<CoarseGarment> moves = without_short_edges(garment);
  if (!moves) return;
  const std::size_t all = garment.mesh.positions.size();
  notes.push_back(
      fmt::format("cloth \"{}\": {} of {} vertices ride on the others: their edges are shorter than {:.2g} mm, where "
                  "nobody sees them move",
                  garment.name, all - moves->kept.size(), all, 1e3 * shortest_edge(garment)));
}

}  // namespace

ClothSetup common_setup(const Shot& shot, const BakePlan& plan) {
  ClothSetup setup;
  take_from_shot(shot, plan.wind, setup);
  setup.max_substeps = shot.solver.max_substeps;
  setup.newton_iterations = shot.solver.newton_iterations;
  setup.linear_tolerance = shot.solver.linear_tolerance;
  setup.feasible.gap = shot.solver.gap;
  setup.feasible.carve = shot.solver.carve;
  return setup;
}

Result<std::unique_ptr<ClothGroup>> cloths_of(const Shot& shot, std::size_t p, BakePlan& plan) {
  auto made = std::make_unique<ClothGroup>(p);
  ClothGroup& group = *made;
  group.setup = common_setup(shot, plan);
  group.setup.primary = plan.primaries[p].trajectory;
  group.setup.teleports = plan.primaries[p].scan.teleports;
  std::vector<const ClothSpec*> worn;
  for (const ClothSpec* spec : specs_of<ClothSpec>(shot.secondaries)) {
    if (spec->on != plan.primaries[p].name) continue;
    if (const Status added = add_garment(shot, *spec, plan.primaries[p], group, plan.notes); !added)
      return added.error();
    group.outputs.back().primary = p;
    worn.push_back(spec);
  }
  for (std::size_t g = 0; g < worn.size(); ++g)
    if (const Status added = add_pins(shot, *worn[g], plan.primaries[p], group, g, plan.notes); !added)
      return added.error();
  if (const Status added = add_ignored(shot, shot.primaries[p], plan.primaries[p], worn, group, plan.notes); !added)
    return added.error();
  for (const ClothGarment& garment : group.setup.garments) note_riding(garment, plan.notes);
  return made;
}

}  // namespace ft::inline baker

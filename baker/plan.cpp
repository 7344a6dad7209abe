#include "baker/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "baker/pins.h"
#include "baker/plan_cords.h"
#include "baker/quality.h"
#include "baker/vertex_maps.h"
#include "io/shot/mesh_file.h"
#include "io/shot/weld.h"
#include "solvers/cloth/coarse_garment.h"

namespace ft {
namespace {

// A primary outside these sizes is a slip of units, nearly always: said, unless the shot file sets the scale itself
// [m].
constexpr double k_smallest_primary = 0.05, k_largest_primary = 30;

/// What moves by less than this share of its size over a whole shot stands still.
constexpr double k_still = 1e-5;

constexpr double k_prop_step = 1.0 / 600;  ///< longest between samples of a prop's adjusted track [s]

std::string cloth_place(const Shot& shot, const ClothSpec& cloth) {
  return shot.file.filename().string() + ": cloth \"" + cloth.name + "\"";
}

ImportRequest import_request(const Shot& shot, const PrimarySpec& spec, const std::filesystem::path& cache) {
  ImportRequest request;
  request.file = spec.file;
  request.animation = spec.animation;
  request.topology = spec.topology;
  request.clip = spec.clip;
  request.clip_start = spec.clip_start;
  request.clip_bind = spec.clip_bind;
  request.speed = spec.speed;
  request.unit_scale = spec.unit_scale.value_or(0);
  request.up = spec.up;
  request.source_fps = spec.source_fps.value_or(0);
  request.shot_fps = shot.fps;
  if (!spec.body.empty()) request.body = spec.body;
  request.height = spec.height.value_or(0);
  request.meshes = spec.meshes;
  request.preroll = shot.preroll / shot.fps;
  request.duration = (shot.last_frame - shot.first_frame) / shot.fps;
  request.first_frame = shot.first_frame;
  request.cache_folder = cache;
  request.keep_character = is_hybrid(shot, spec.name);
  return request;
}

std::vector<Vec3> bind_pose(const Trajectory& trajectory) {
  std::vector<Vec3> out(static_cast<std::size_t>(trajectory.surface().vertex_count()));
  trajectory.bind_pose(out);
  return out;
}

Status check_primary(const Shot& shot, const PrimarySpec& spec, const Trajectory& trajectory, const CharacterInfo& info,
                     std::vector<std::string>& notes) {
  const std::string where = shot.file.filename().string() + ": primary \"" + spec.name + "\"";
  const auto pose = bind_pose(trajectory);
  if (pose.empty() || trajectory.surface().triangles.empty())
    return input_error("there is no surface in " + spec.file.filename().string(), where,
                       "cloth needs a body: a mesh, or a BVH, for which one is built");
  if (!all_finite(pose)) return input_error("the bind pose has positions that are not finite", where);
  const double size = bounds(pose).size().maxCoeff();
  if (!spec.unit_scale && !spec.height && !(size >= k_smallest_primary && size <= k_largest_primary))
    return input_error(
        fmt::format("the character is {:.4g} m in size", size), where,
        size > k_largest_primary
            ? "if the file is in centimetres, write unit_scale = 0.01; any unit_scale or height silences this"
            : "write unit_scale, in metres per unit of the file, or height");
  // Every frame's pose is looked at once before the first is solved: a pose that is not finite must not reach a solver.
  std::vector<Vec3> sample(pose.size()), first;
  bool moves = false;
  for (int frame = shot.first_frame; frame <= shot.last_frame; ++frame) {
    trajectory.sample((frame - shot.first_frame) / shot.fps, sample);
    if (!all_finite(sample)) return input_error(fmt::format("the pose at frame {} is not finite", frame), where);
    if (frame == shot.first_frame) first = sample;
    for (std::size_t v = 0; v < sample.size() && !moves; ++v) moves = (sample[v] - first[v]).norm() > k_still * size;
  }
  if (!moves && shot.last_frame > shot.first_frame && !info.still)
    notes.push_back(fmt::format("primary \"{}\" does not move in frames {}-{}: is it the right clip, and clip_start?",
                                spec.name, shot.first_frame, shot.last_frame));
  return {};
}

TeleportScan scan_of(const Shot& shot, const PrimarySpec& spec, const Trajectory& trajectory) {
  TeleportScanSettings settings;
  settings.first_frame = shot.first_frame;
  settings.last_frame = shot.last_frame;
  settings.preroll_frames = shot.preroll;
  settings.fps = shot.fps;
  settings.detect = spec.teleports == Teleports::k_detect;
  settings.frames = spec.teleport_frames;
  return scan_teleports(trajectory, settings);
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
  out.stiffness = pin.stiffness;
  out.max_pull = pin.max_pull;
  for (const auto& [vertex, weight] : weight_of) out.vertices.push_back(vertex), out.weights.push_back(weight);
  return out;
}

Status add_garment(const Shot& shot, const ClothSpec& spec, const PrimaryPlan& primary, GroupPlan& group,
                   std::vector<std::string>& notes) {
  const auto located = [&](Error error) {
    error.where = cloth_place(shot, spec) + (error.where.empty() ? "" : ": " + error.where);
    return error;
  };
  std::vector<std::string> mesh_notes;
  auto mesh = read_obj(spec.mesh, &mesh_notes);
  if (!mesh) return located(mesh.error());
  ClothGarment garment;
  GarmentOutput output;
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
  }
  if (const Status checked = check_garment(garment.mesh); !checked) {
    Error error = located(checked.error());
    if (error.where.find(spec.mesh.filename().string()) == std::string::npos) error.where += ": " + spec.mesh.string();
    return error;
  }
  for (const std::string& note : inspect_garment(garment.mesh).notes) mesh_notes.push_back(note);
  for (const std::string& note : mesh_notes) notes.push_back("cloth \"" + spec.name + "\": " + note);

  if (spec.rest == "pattern" || (spec.rest.empty() && !garment.mesh.stitches.empty())) {
    std::vector<std::string> pattern_notes;
    if (const Status cut = check_pattern(garment.mesh, spec.pattern_scale, pattern_notes); !cut)
      return located(cut.error());
    for (const std::string& note : pattern_notes) notes.push_back("cloth \"" + spec.name + "\": " + note);
    garment.pattern_scale = spec.pattern_scale;
  }
  garment.sewing_time = spec.sewing_time;
  if (!garment.mesh.stitches.empty() && spec.sewing_time > shot.preroll / shot.fps)
    notes.push_back(fmt::format(
        "cloth \"{}\": its seams close {:.3g} s after the shot's first frame: sewing_time is longer than the pre-roll",
        spec.name, spec.sewing_time - shot.preroll / shot.fps));
  if (!garment.mesh.stitches.empty() && shot.preroll == 0)
    notes.push_back(fmt::format("cloth \"{}\" is sewn in the shot's first frames: there is no pre-roll", spec.name));

  const Fabric* fabric = find_fabric(spec.fabric);
  if (!fabric) return located(usage_error("fabric \"" + spec.fabric + "\" does not exist"));
  garment.fabric = *fabric;
  for (const auto& [key, value] : spec.fabric_overrides)
    if (!set_fabric_value(garment.fabric, key, value))
      return located(usage_error("fabric has no value \"" + key + "\""));

  auto maps = resolve_maps(spec.maps, *output.mesh);
  if (!maps) return located(maps.error());
  garment.maps =
      output.joined_of.empty() ? std::move(*maps) : on_joined(*maps, output.joined_of, garment.mesh.vertex_count());
  garment.thickness = spec.thickness;
  garment.friction = spec.friction;
  garment.self_friction = spec.self_friction;
  garment.self_collision = spec.self_collision;

  const Box cloth_box = bounds(garment.mesh.positions);
  Box body_box = bounds(bind_pose(*primary.trajectory));
  const double ratio = cloth_box.size().maxCoeff() / body_box.size().maxCoeff();
  if (ratio > 10 || ratio < 0.01)
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
Status add_pins(const Shot& shot, const ClothSpec& spec, const PrimaryPlan& primary, GroupPlan& group, std::size_t own,
                std::vector<std::string>& notes) {
  auto& garments = group.setup.garments;
  const auto located = [&](Error error) {
    error.where = cloth_place(shot, spec) + (error.where.empty() ? "" : ": " + error.where);
    return error;
  };
  const GarmentOutput& output = group.outputs[own];
  const auto body = bind_pose(*primary.trajectory);
  for (const PinSpec& pin_spec : spec.pins) {
    const auto target = std::find_if(garments.begin(), garments.end(),
                                     [&](const ClothGarment& garment) { return garment.name == pin_spec.to; });
    const bool to_world = pin_spec.to == k_pin_world, to_cloth = !pin_spec.to.empty() && !to_world;
    CHECK(!to_cloth || target != garments.end());  // the shot file was judged
    auto resolved = to_cloth ? resolve_pin(pin_spec, *output.mesh, target->mesh.positions, triangulate(target->mesh))
                             : resolve_pin(pin_spec, *output.mesh, body, primary.trajectory->surface().triangles);
    if (!resolved) return located(resolved.error());
    ClothPin pin = output.joined_of.empty() ? std::move(*resolved) : on_joined(*resolved, output.joined_of);
    pin.hold = hold_span(pin_spec, shot);
    pin.opens = pin_spec.opens;
    pin.to_world = to_world;
    if (to_cloth) {
      pin.to = static_cast<int>(target - garments.begin());
      if (const Status held = check_footholds(garments, own, pin, notes); !held) return located(held.error());
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

ClothSetup common_setup(const Shot& shot) {
  ClothSetup setup;
  setup.first_frame = shot.first_frame;
  setup.fps = shot.fps;
  setup.preroll_frames = shot.preroll;
  setup.gravity = shot.solver.gravity;
  setup.wind = shot.wind.velocity;
  setup.min_substeps = shot.solver.min_substeps;
  setup.max_substeps = shot.solver.max_substeps;
  setup.newton_iterations = shot.solver.newton_iterations;
  setup.linear_tolerance = shot.solver.linear_tolerance;
  setup.bdf2 = shot.solver.integrator == "bdf2";
  setup.feasible.gap = shot.solver.gap;
  setup.feasible.carve = shot.solver.carve;
  return setup;
}

}  // namespace

void place_garment(Mesh& mesh, const ClothSpec& spec) {
  for (Vec3& p : mesh.positions) {
    p *= spec.unit_scale;
    if (spec.up == "z") p = Vec3(p.x(), p.z(), -p.y());
    p += spec.offset;
  }
}

namespace {

void note_pass(const HybridPass& pass, const std::string& primary, std::vector<std::string>& notes) {
  notes.push_back(pass.text(primary));
  notes.insert(notes.end(), pass.notes.begin(), pass.notes.end());
}

Result<PrimaryPlan> plan_character(const Shot& shot, const PrimarySpec& spec, const Importer& importer,
                                   const std::filesystem::path& import_cache, std::vector<std::string>& notes) {
  const ImportRequest request = import_request(shot, spec, import_cache);
  auto imported = importer(request);
  if (!imported) return imported.error();
  CHECK(imported->trajectory);
  for (const std::string& note : imported->info.notes) notes.push_back("primary \"" + spec.name + "\": " + note);
  if (const Status checked = check_primary(shot, spec, *imported->trajectory, imported->info, notes); !checked)
    return checked.error();
  PrimaryPlan out;
  out.name = spec.name;
  out.scan = scan_of(shot, spec, *imported->trajectory);
  for (std::string& note : teleport_notes(out.scan, spec.name)) notes.push_back(std::move(note));
  out.mass = primary_mass(spec, *imported->trajectory);
  out.trajectory = std::move(imported->trajectory);
  out.info = std::move(imported->info);
  if (imported->character && has_joints(*imported->character)) {
    auto yielded = yield_character(shot, spec, request, imported->character, *out.trajectory, out.mass.kilograms);
    if (!yielded) return yielded.error();
    note_pass(yielded->pass, spec.name, notes);
    notes.insert(notes.end(), yielded->notes.begin(), yielded->notes.end());
    out.trajectory = std::move(yielded->trajectory);
    out.hybrid = std::make_shared<const HybridPass>(std::move(yielded->pass));
    out.yielding = std::make_shared<const YieldingCharacter>(std::move(yielded->character));
  }
  return out;
}

/// Whether something asks for a primary that is one rigid body: cords on it, or a coupling that moves it.
bool has_to_be_rigid(const Shot& shot, const PrimaryPlan& primary) {
  return (is_hybrid(shot, primary.name) && !primary.yielding) ||
         std::any_of(shot.cords.begin(), shot.cords.end(), [&](const CordsSpec& c) { return c.on == primary.name; });
}

/// Its prop, and where it goes: along its track or, once stand-ins have been met, the adjusted one.
Status plan_prop(const Shot& shot, const PrimarySpec& spec, PrimaryPlan& primary, std::vector<std::string>& notes) {
  if (!spec.shape.empty()) {
    primary.prop = std::make_shared<const Prop>(prop_of_shape(spec, shot));
  } else if (has_to_be_rigid(shot, primary)) {
    auto prop = prop_of_trajectory(spec, shot, primary.trajectory, primary.mass.kilograms);
    if (!prop) return prop.error();
    primary.prop = std::make_shared<const Prop>(std::move(*prop));
  } else {
    return {};
  }
  primary.track = primary.prop->track;
  if (is_hybrid(shot, spec.name) && !primary.hybrid) {
    const Prop& prop = *primary.prop;
    DrivenBody body{prop.mass, prop.track, [samples = prop.samples](double) { return std::span(samples); }};
    auto pass = hybrid_pass(shot, spec, std::move(body), k_prop_step, Vec3::Ones());
    if (!pass) return pass.error();
    primary.track = [before = prop.track, after = sampled_motion(0, pass->dt, pass->motion)](double time) {
      return time < 0 ? before(time) : after(time);
    };
    note_pass(*pass, spec.name, notes);
    primary.hybrid = std::make_shared<const HybridPass>(std::move(*pass));
  }
  primary.trajectory = prop_trajectory(*primary.prop, primary.track, shot.preroll / shot.fps);
  if (!spec.shape.empty()) {
    primary.mass = primary_mass(spec, *primary.trajectory);
    primary.info.format = spec.shape;
    primary.info.vertex_count = primary.trajectory->surface().vertex_count();
    primary.info.triangle_count = static_cast<int>(primary.trajectory->surface().triangles.size());
    primary.info.bind_bounds = bounds(bind_pose(*primary.trajectory));
    primary.info.up = "y";
  }
  return {};
}

Status plan_cloths(const Shot& shot, std::size_t p, BakePlan& plan) {
  GroupPlan group{p, common_setup(shot), {}, {}};
  group.setup.primary = plan.primaries[p].trajectory;
  group.setup.teleports = plan.primaries[p].scan.teleports;
  std::vector<const ClothSpec*> worn;
  for (const ClothSpec& spec : shot.cloths) {
    if (spec.on != plan.primaries[p].name) continue;
    if (const Status added = add_garment(shot, spec, plan.primaries[p], group, plan.notes); !added) return added;
    worn.push_back(&spec);
  }
  for (std::size_t g = 0; g < worn.size(); ++g)
    if (const Status added = add_pins(shot, *worn[g], plan.primaries[p], group, g, plan.notes); !added) return added;
  if (group.setup.garments.empty()) return {};
  for (const ClothGarment& garment : group.setup.garments) note_riding(garment, plan.notes);
  apply_quality(shot, group.setup);
  group.setup.poses = std::make_shared<FeasiblePoses>(group.setup.primary, group.setup.feasible);
  plan.groups.push_back(std::move(group));
  return {};
}

}  // namespace

Result<BakePlan> make_plan(BakeInputs inputs, const Importer& importer, const std::filesystem::path& import_cache) {
  BakePlan plan;
  plan.inputs = std::move(inputs);
  const Shot& shot = plan.shot();
  plan.notes = shot.notes;
  const auto clock = std::chrono::steady_clock::now();
  for (const PrimarySpec& spec : shot.primaries) {
    PrimaryPlan primary;
    primary.name = spec.name;
    if (spec.shape.empty()) {
      auto character = plan_character(shot, spec, importer, import_cache, plan.notes);
      if (!character) return character.error();
      primary = std::move(*character);
    }
    if (const Status planned = plan_prop(shot, spec, primary, plan.notes); !planned) return planned.error();
    plan.primaries.push_back(std::move(primary));
  }
  if (is_preview(shot)) plan.notes.push_back(quality_note());
  plan.import_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();

  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    if (const Status planned = plan_cloths(shot, p, plan); !planned) return planned.error();
    if (const Status planned = plan_cords(shot, p, plan); !planned) return planned.error();
    const auto of_it = [&](const GroupPlan& group) { return group.primary == p; };
    if (plan.primaries[p].hybrid && std::none_of(plan.groups.begin(), plan.groups.end(), of_it))
      plan.groups.push_back({p, common_setup(shot), {}, {}});
  }
  if (plan.groups.empty()) return usage_error("no cloth or cords are on any primary", shot.file.string());
  return plan;
}

}  // namespace ft

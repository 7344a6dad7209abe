#include "baker/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "baker/plan/air.h"
#include "baker/plan/carrier.h"
#include "baker/plan/known_motion.h"
#include "baker/plan/output_formats.h"
#include "baker/plan/placed_trajectory.h"
#include "baker/plan/preroll_speed.h"
#include "baker/plan/quality.h"
#include "baker/plan/repeated_trajectory.h"
#include "io/shot/chains.h"

namespace ft::inline baker {
namespace {

// A primary outside these sizes is a slip of units, nearly always: said, unless the shot file sets the scale itself
// [m].
constexpr double k_smallest_primary = 0.05, k_largest_primary = 30;

/// What moves by less than this share of its size over a whole shot stands still.
constexpr double k_still = 1e-5;

constexpr double k_prop_step = 1.0 / 600;  ///< longest between samples of a prop's adjusted track [s]

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
  request.surface = spec.surface;
  request.preroll = shot.preroll / shot.fps;
  // What is repeated need not last as long as the shot; whether it does is looked at once its length is known.
  request.duration = spec.repeat > 1 ? 0 : (shot.last_frame - shot.first_frame) / shot.fps;
  request.first_frame = shot.first_frame;
  request.cache_folder = cache;
  const auto asks = [&](const auto& s) { return s->on == spec.name && s->section->needs_character(); };
  request.keep_character =
      is_hybrid(shot, spec.name) || std::any_of(shot.secondaries.begin(), shot.secondaries.end(), asks);
  return request;
}

Status check_primary(const Shot& shot, const PrimarySpec& spec, const Trajectory& trajectory, const CharacterInfo& info,
                     std::vector<std::string>& notes) {
  const std::string where = shot.file.filename().string() + ": primary \"" + spec.name + "\"";
  const auto pose = bind_pose_of(trajectory);
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

void note_pass(const HybridPass& pass, const std::string& primary, std::vector<std::string>& notes) {
  notes.push_back(pass.text(primary));
  notes.insert(notes.end(), pass.notes.begin(), pass.notes.end());
}

/// As often in a row as `repeat` says.
Status repeat_clip(const Shot& shot, const PrimarySpec& spec, ImportedPrimary& imported,
                   std::vector<std::string>& notes) {
  if (spec.repeat <= 1) return {};
  const std::string where = shot.file.filename().string() + ": primary \"" + spec.name + "\"";
  if (is_hybrid(shot, spec.name)) return usage_error("what yields to stand-ins cannot be repeated", where);
  for (const auto& secondary : shot.secondaries)
    if (secondary->on == spec.name && secondary->section->needs_character())
      return usage_error("its clip is repeated, and " + secondary->owner() + " changes the clip itself", where,
                         "repeat the clip in the program that it comes from");
  const auto& clips = imported.info.clips;
  const auto clip = std::find_if(clips.begin(), clips.end(),
                                 [&](const ClipInfo& c) { return spec.clip.empty() || c.name == spec.clip; });
  if (clip == clips.end()) return usage_error("repeat needs a clip to repeat", where);
  const double period = (clip->duration - spec.clip_start) / spec.speed;
  const double needed = (shot.last_frame - shot.first_frame) / shot.fps;
  if (!(period > 0)) return usage_error("clip_start is behind the clip's end: there is nothing to repeat", where);
  if (period * spec.repeat < needed - 1e-6)
    return usage_error(fmt::format("{} times its clip last {:.4g} s, and the shot {:.4g} s", spec.repeat,
                                   period * spec.repeat, needed),
                       where, fmt::format("repeat = {}", static_cast<int>(std::ceil(needed / period))));
  auto repeated = std::make_unique<RepeatedTrajectory>(std::move(imported.trajectory), period, spec.repeat);
  constexpr double k_no_cycle = 0.02;  // m
  if (repeated->misfit() > k_no_cycle)
    notes.push_back(
        fmt::format("primary \"{}\": its clip does not end as it begins: it jumps by {:.2g} cm where it "
                    "is repeated",
                    spec.name, 100 * repeated->misfit()));
  imported.trajectory = std::move(repeated);
  return {};
}

/// Where `position` and `rotation` have it.
Status place_character(const Shot& shot, const PrimarySpec& spec, ImportedPrimary& imported, Eigen::Isometry3d& place) {
  if (spec.position == Vec3::Zero() && spec.rotation_deg == Vec3::Zero()) return {};
  if (is_hybrid(shot, spec.name))
    return usage_error("a character that yields to stand-ins cannot have position or rotation",
                       shot.file.filename().string() + ": primary \"" + spec.name + "\"",
                       "move it in the program that it comes from");
  place = Eigen::Translation3d(spec.position) * rotation_of_degrees(spec.rotation_deg);
  imported.trajectory = std::make_unique<PlacedTrajectory>(std::move(imported.trajectory), place);
  return {};
}

Result<PrimaryPlan> plan_character(const Shot& shot, const PrimarySpec& spec, const Importer& importer,
                                   const std::filesystem::path& import_cache, std::vector<std::string>& notes) {
  const ImportRequest request = import_request(shot, spec, import_cache);
  auto imported = importer(request);
  if (!imported) return imported.error();
  CHECK(imported->trajectory);
  if (const Status repeated = repeat_clip(shot, spec, *imported, notes); !repeated) return repeated.error();
  for (const std::string& note : imported->info.notes) notes.push_back("primary \"" + spec.name + "\": " + note);
  if (const Status checked = check_primary(shot, spec, *imported->trajectory, imported->info, notes); !checked)
    return checked.error();
  PrimaryPlan out;
  if (const Status placed = place_character(shot, spec, *imported, out.place); !placed) return placed.error();
  out.name = spec.name;
  out.scan = scan_of(shot, spec, *imported->trajectory);
  for (std::string& note : teleport_notes(out.scan, spec.name)) notes.push_back(std::move(note));
  if (auto note = hasty_preroll(shot, spec.name, *imported->trajectory)) notes.push_back(std::move(*note));
  out.mass = primary_mass(spec, *imported->trajectory);
  out.trajectory = std::move(imported->trajectory);
  out.info = std::move(imported->info);
  out.character = imported->character;
  out.request = request;
  if (is_hybrid(shot, spec.name) && imported->character && has_joints(*imported->character)) {
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

/// Whether something asks for a primary that is one rigid body: a secondary that asks for it, or a coupling that moves
/// it.
bool has_to_be_rigid(const Shot& shot, const PrimaryPlan& primary) {
  return (is_hybrid(shot, primary.name) && !primary.yielding) ||
         std::any_of(shot.secondaries.begin(), shot.secondaries.end(),
                     [&](const auto& s) { return s->on == primary.name && s->section->needs_rigid_primary(); });
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
    primary.info.bind_bounds = bounds(bind_pose_of(*primary.trajectory));
    primary.info.up = "y";
  }
  return {};
}

/// Whether some secondary is on the primary.
bool has_secondaries(const BakePlan& plan, std::size_t primary) {
  return std::any_of(plan.groups.begin(), plan.groups.end(), [&](const auto& group) {
    return std::any_of(group->outputs.begin(), group->outputs.end(),
                       [&](const SystemOutput& output) { return output.primary == primary; });
  });
}

/// What the kinds plan from: of the secondaries those of this stage, with what carries them among the primaries.
Shot shot_of_stage(const BakePlan& plan) {
  Shot out = plan.shot();
  for (std::size_t p = out.primaries.size(); p < plan.primaries.size(); ++p) {
    out.primaries.emplace_back();
    out.primaries.back().name = plan.primaries[p].name;
  }
  const std::vector<int> stages = stages_of(out.secondaries);
  Secondaries own;
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (stages[i] == plan.stage) own.push_back(out.secondaries[i]);
  out.secondaries = std::move(own);
  return out;
}

/// Groups of all kinds, by their first primary; behind them primaries that yield and have no secondary.
Status plan_systems(BakePlan& plan) {
  const Shot shot = shot_of_stage(plan);
  for (const SystemKind* kind : system_kinds()) {
    auto groups = kind->plan(shot, plan);
    if (!groups) return groups.error();
    for (auto& group : *groups) plan.groups.push_back(std::move(group));
  }
  for (std::size_t p = 0; p < plan.primaries.size() && plan.stage == 0; ++p)
    if (plan.primaries[p].hybrid && !has_secondaries(plan, p))
      plan.groups.push_back(std::make_unique<BodyGroup>(p, shot.first_frame, shot.preroll, shot.fps));
  std::stable_sort(plan.groups.begin(), plan.groups.end(),
                   [](const auto& a, const auto& b) { return a->primary < b->primary; });
  return check_output_formats(plan);
}

/// So that what is wrong with a later stage shows now and not when the first is baked.
Status plan_later_stages(BakePlan& plan) {
  for (int stage = 1; stage < plan.stage_count; ++stage) {
    const BakePlan& before = stage == 1 ? plan : plan.later.back();
    std::vector<PrimaryPlan> carriers;
    for (const Carrier& carrier : carriers_of(before)) carriers.push_back(standing_carrier(carrier, before));
    auto next = plan_next_stage(before, std::move(carriers));
    if (!next) return next.error();
    plan.later.push_back(std::move(*next));
  }
  return {};
}

}  // namespace

Result<BakePlan> plan_next_stage(const BakePlan& before, std::vector<PrimaryPlan> carriers) {
  BakePlan plan;
  plan.inputs = before.inputs;
  plan.stage = before.stage + 1;
  plan.stage_count = before.stage_count;
  plan.primaries = before.primaries;
  plan.wind = before.wind;
  plan.import_seconds = before.import_seconds;
  for (PrimaryPlan& carrier : carriers) plan.primaries.push_back(std::move(carrier));
  if (const Status planned = plan_systems(plan); !planned) return planned.error();
  return plan;
}

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
  auto wind = plan_wind(shot, plan.primaries, plan.notes);
  if (!wind) return wind.error();
  plan.wind = std::move(*wind);
  if (is_preview(shot)) plan.notes.push_back(quality_note());
  plan.import_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();

  for (const int stage : stages_of(shot.secondaries)) plan.stage_count = std::max(plan.stage_count, stage + 1);
  if (const Status planned = plan_systems(plan); !planned) return planned.error();
  if (plan.groups.empty()) return usage_error("no secondary is on any primary", shot.file.string());
  if (const Status planned = plan_later_stages(plan); !planned) return planned.error();
  return plan;
}

}  // namespace ft::inline baker

#include "baker/plan/character_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/plan/placed_trajectory.h"
#include "baker/plan/repeated_trajectory.h"

namespace ft::inline baker {
namespace {

// A primary outside these sizes is a slip of units, nearly always: said, unless the shot file sets the scale itself
// [m].
constexpr double k_smallest_primary = 0.05, k_largest_primary = 30;

/// What moves by less than this share of its size over a whole shot stands still.
constexpr double k_still = 1e-5;

ImportRequest import_request(const Shot& shot, const PrimarySpec& spec, const std::filesystem::path& cache) {
  ImportRequest request;
  request.file = spec.file;
  request.animation = spec.animation;
  request.topology = spec.topology;
  request.clip = spec.clip;
  request.clip_start = spec.clip_start;
  request.clip_bind = spec.clip_bind;
  request.speed = spec.speed;
  request.loop = spec.loop;
  request.unit_scale = spec.unit_scale.value_or(0);
  request.up = spec.up;
  request.source_fps = spec.source_fps.value_or(0);
  request.shot_fps = shot.fps;
  if (!spec.body.empty()) request.body = spec.body;
  request.bind = spec.bind;
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

/// Without the jumps at seams after the first one: each cycle has the same, and the note on the cycle names them.
TeleportScan told_once(const TeleportScan& scan, const std::vector<int>& seam_frames) {
  TeleportScan out;
  std::vector<int> later(seam_frames.begin() + (seam_frames.empty() ? 0 : 1), seam_frames.end());
  const auto is_told = [&](int frame) { return std::binary_search(later.begin(), later.end(), frame); };
  for (std::size_t i = 0; i < scan.teleports.size(); ++i) {
    if (is_told(scan.teleports[i].frame)) continue;
    out.teleports.push_back(scan.teleports[i]);
    out.distances.push_back(scan.distances[i]), out.turns.push_back(scan.turns[i]);
  }
  for (const PartJump& jump : scan.part_jumps)
    if (!is_told(jump.frame)) out.part_jumps.push_back(jump);
  return out;
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

}  // namespace

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
  for (std::string& note : teleport_notes(told_once(out.scan, imported->info.seam_frames), spec.name))
    notes.push_back(std::move(note));
  out.mass = primary_mass(spec, *imported->trajectory);
  if (const std::string note = out.mass.note(); !note.empty())
    notes.push_back("primary \"" + spec.name + "\": " + note);
  out.trajectory = std::move(imported->trajectory);
  out.info = std::move(imported->info);
  out.character = imported->character;
  out.request = request;
  if (is_hybrid(shot, spec.name) && imported->character && has_joints(*imported->character)) {
    auto yielded = yield_character(shot, spec, request, imported->character, *out.trajectory, out.mass.kilograms);
    if (!yielded) return yielded.error();
    for (std::string& line : yielded->pass.lines(spec.name)) notes.push_back(std::move(line));
    notes.insert(notes.end(), yielded->notes.begin(), yielded->notes.end());
    out.trajectory = std::move(yielded->trajectory);
    out.hybrid = std::make_shared<const HybridPass>(std::move(yielded->pass));
    out.yielding = std::make_shared<const YieldingCharacter>(std::move(yielded->character));
  }
  return out;
}

}  // namespace ft::inline baker

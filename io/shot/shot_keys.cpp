#include "io/shot/shot_keys.h"

#include <algorithm>

#include "io/shot/key_reader.h"
#include "io/shot/key_text.h"
#include "io/shot/secondary.h"
#include "io/shot/shot_judge.h"
#include "io/shot/words.h"

namespace ft::inline io {

namespace {

void read_frames_key(const KeyReader&, const ValueReader& reader, const Value& value, const Allowed&, Shot& shot) {
  if (const auto range = read_frames(reader, value)) shot.first_frame = range->first, shot.last_frame = range->last;
}
std::string frames_key_text(const Shot& shot, const std::filesystem::path&) {
  return toml_text(frames_text({shot.first_frame, shot.last_frame}));
}

void read_most_key(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed&, Shot& shot) {
  if (value.kind != Value::Kind::k_table)
    return reader.fault(value, "needs a table like { kinetic_energy = 5 }, not " + describe(value));
  const auto known = keys.vocabulary().lists.find("@metrics");
  for (const Member& member : value.members) {
    const bool is_known = known == keys.vocabulary().lists.end() ||
                          std::find(known->second.begin(), known->second.end(), member.key) != known->second.end();
    if (!is_known)
      keys.faults().add(member.place, with_hint(reader.owner + ", most: there is no metric " + in_quotes(member.key),
                                                suggestion(member.key, known->second)));
    const auto limit = ValueReader{keys.faults(), reader.owner + ", most", member.key}.number(member.value, {});
    if (limit && is_known) shot.gate_most.emplace_back(member.key, *limit);
  }
}
std::string most_key_text(const Shot& shot, const std::filesystem::path&) {
  std::string out;
  for (const auto& [key, limit] : shot.gate_most)
    out.append(out.empty() ? "{ " : ", ").append(key).append(" = ").append(number_text(limit));
  return out.empty() ? out : out.append(" }");
}

void read_teleports_key(const KeyReader&, const ValueReader& reader, const Value& value, const Allowed& allowed,
                        PrimarySpec& spec) {
  read_teleports(reader, value, {allowed.lowest, allowed.highest, allowed.unit, true}, spec);
}
std::string teleports_key_text(const PrimarySpec& spec, const std::filesystem::path&) {
  if (spec.teleports != Teleports::k_frames)
    return toml_text(spec.teleports == Teleports::k_detect ? "detect" : "ignore");
  std::string out = "[";
  for (const int frame : spec.teleport_frames) out.append(out.size() > 1 ? ", " : "").append(std::to_string(frame));
  return out.append("]");
}

}  // namespace

std::span<const ShotKey<Shot>> shot_keys() {
  static const ShotKey<Shot> keys[] = {
      {"frames", OwnGrammar<Shot>{"frames", read_frames_key, frames_key_text}, 0, 9'999'999, "", "", true,
       "frame_range range start end first last", "First and last frame, `\"1001-1121\"`, or one frame"},
      {"fps", &Shot::fps, 1, 240, "1/s", "", false, "frame_rate framerate frames_per_second",
       "Frames per second of the shot"},
      {"preroll", &Shot::preroll, 0, 1000, "frames", "", false, "warmup run_up pre_roll",
       "Frames before the first, in which the bind pose blends into the first frame and the cloth settles; a shot that "
       "does not name it has more of them where a character would tear away from its bind pose; with 0, cloth that "
       "starts through the body stays there"},
      {"write_preroll", &Shot::write_preroll, 0, 0, "", "", false, "",
       "Also write the frames of the pre-roll into the caches"},
      {"quality", &Shot::quality, 0, 0, "", "final preview", false, "",
       "`preview` bakes several times faster with a larger error, for setting a shot up"},
  };
  return keys;
}

std::span<const ShotKey<PrimarySpec>> primary_keys() {
  static const ShotKey<PrimarySpec> keys[] = {
      {"file", &PrimarySpec::file, 0, 0, "", "", false, "mesh path model character",
       "Character (FBX, glTF/GLB, DAE, BVH, ...) or geometry cache (Alembic, PC2, MDD, OBJ sequence); or `shape`, "
       "below"},
      {"animation", &PrimarySpec::animation, 0, 0, "", "", false, "motion anim",
       "Second file with the motion for the skeleton in `file`, matched by node name"},
      {"topology", &PrimarySpec::topology, 0, 0, "", "", false, "faces mesh",
       "For caches without faces (PC2, MDD): the OBJ with the same vertices"},
      {"clip", &PrimarySpec::clip, 0, 0, "", "", false, "take action",
       "Name of the clip; without it the only one, or the first"},
      {"clip_start", &PrimarySpec::clip_start, 0, 100'000, "s", "", false, "offset start",
       "Time within the clip at the shot's first frame; garments for a geometry cache are modelled on its pose there"},
      {"speed", &PrimarySpec::speed, 0.01, 100, "1", "", false, "time_scale", "Playback speed; 2 is twice as fast"},
      {"loop", &PrimarySpec::loop, 0, 0, "", "", false, "loops looped looping cycle cycles cyclic",
       "The whole clip repeats as long as the shot lasts; each cycle goes on from where the last one has got to on "
       "the ground, and in its heading"},
      {"repeat", &PrimarySpec::repeat, 1, 10'000, "times", "", false, "repeats times",
       "Plays the clip, from `clip_start` to its end, so often in a row, each time from where the last one has got to"},
      {"unit_scale", &PrimarySpec::unit_scale, 1e-6, 1000, "m per file unit", "", false, "scale units unit",
       "Overrides the unit that the file states; 0.01 for centimetres"},
      {"up", &PrimarySpec::up, 0, 0, "", "y z", false, "up_axis axis", "Up axis, when the file states a wrong one"},
      {"source_fps", &PrimarySpec::source_fps, 1, 10'000, "1/s", "", false, "fps sample_rate",
       "Geometry caches: samples per second; without it the shot's fps"},
      {"body", &PrimarySpec::body, 0, 0, "", "blended capsules", false, "",
       "BVH, which has no body: how one is built around the skeleton"},
      {"bind", &PrimarySpec::bind, 0, 0, "", "t_pose", false, "bind_pose rest_pose",
       "Pose that garments are modelled on: a T-pose made from the skeleton; without it the file's bind pose"},
      {"height", &PrimarySpec::height, 0.05, 50, "m", "", false, "size",
       "Scales the character so that its bind pose is this tall"},
      {"mass", &PrimarySpec::mass, 1e-3, 1e6, "kg", "", false, "weight",
       "Mass, for the accelerations that its secondaries' forces cause; without it from the body's volume. Two-way "
       "coupling needs it"},
      {"meshes", &PrimarySpec::meshes, 0, 0, "", "", false, "mesh objects",
       "Names of the meshes that make the collider; without it all"},
      {"surface", &PrimarySpec::surface, 0, 0, "", "solid sheet", false, "sheet thin open two_sided",
       "Geometry caches: `sheet` has two sides and no inside, as baked cloth does; without it, it is one if its mesh "
       "is open"},
      {"ignore", &PrimarySpec::ignore, 0, 0, "", "", false, "exclude ignore_parts ignored without",
       "Parts that no cloth meets, where they are in its way: names with `*` and `?`, `[\"hand_*\"]`. `info` of the "
       "character lists its parts"},
      {"teleports", OwnGrammar<PrimarySpec>{"text or list of frames", read_teleports_key, teleports_key_text}, 0,
       9'999'999, "", "", false, "teleport cuts jumps",
       "What is done about a character that jumps to another place between two frames: `\"detect\"` carries the cloth "
       "along, `\"ignore\"` simulates it as motion, `[1041]` names the first frame at each new place"},
      {"blocks_wind", &PrimarySpec::blocks_wind, 0, 0, "", "", false, "shelter lee obstacle",
       "What is behind it gets less of the wind"},
  };
  return keys;
}

std::span<const ShotKey<SolverSpec>> solver_keys() {
  static const ShotKey<SolverSpec> keys[] = {
      {"min_substeps", &SolverSpec::min_substeps, 1, 1024, "a frame", "", false, "substeps steps",
       "Substeps of a quiet frame"},
      {"max_substeps", &SolverSpec::max_substeps, 1, 4096, "a frame", "", false, "", "Substeps of the hardest frame"},
      {"newton_iterations", &SolverSpec::newton_iterations, 1, 100, "a substep", "", false, "iterations newton",
       "Newton iterations; up to five times as many where an iteration still strains the cloth"},
      {"linear_tolerance", &SolverSpec::linear_tolerance, 1e-10, 0.5, "1", "", false, "tolerance",
       "Residual at which the first linear solve of a substep stops, relative and in the norm of its preconditioner; "
       "later ones may leave as much"},
      {"integrator", &SolverSpec::integrator, 0, 0, "", "bdf2 euler", false, "method",
       "`bdf2`, for cloth with a quarter of BDF3, keeps the swing; `euler` calms it"},
      {"gap", &SolverSpec::gap, 0, 0.05, "m", "", false, "", "Room kept between overlapping parts of the body"},
      {"carve", &SolverSpec::carve, 0, 0, "", "", false, "", "Make the body free of self-overlap before it collides"},
      {"gravity", &SolverSpec::gravity, -100, 100, "m/s2", "", false, "g", "Acceleration of gravity, world axes, y up"},
  };
  return keys;
}

std::span<const ShotKey<Shot>> cache_keys() {
  static const ShotKey<Shot> keys[] = {
      {"formats", &Shot::cache_formats, 0, 0, "", "@formats", false, "format type", "One cache per cloth and format"},
      {"collider", &Shot::cache_collider, 0, 0, "", "", false, "body",
       "Also write the body that the cloth collided with"},
      {"volumes", &Shot::cache_volumes, 0, 0, "", "", false, "vdb openvdb volume",
       "Also write the water as OpenVDB, a file for each frame, when the bake is done; made from its abc caches, as by "
       "`followthrough volumes`"},
  };
  return keys;
}

std::span<const ShotKey<Shot>> gate_keys() {
  static const ShotKey<Shot> keys[] = {
      {"p99_strain", &Shot::gate_p99_strain, 0, 10, "1", "", false, "strain max_strain",
       "Exit code 4 when the 99th percentile of strain is above it; 0 is off"},
      {"crossings", &Shot::gate_crossings, 0, 0, "", "", false, "no_crossings",
       "Exit code 4 when any frame has crossings"},
      {"most", OwnGrammar<Shot>{"table of numbers", read_most_key, most_key_text}, 0, 0, "", "", false, "limits",
       "Exit code 4 when a metric of any frame is above its limit: `{ kinetic_energy = 5 }`; the frames of the "
       "manifest have all metrics"},
  };
  return keys;
}

std::vector<std::string> split_words(std::string_view words) {
  std::vector<std::string> out;
  while (!words.empty()) {
    const std::size_t end = words.find(' ');
    if (end != 0) out.emplace_back(words.substr(0, end));
    words.remove_prefix(end == std::string_view::npos ? words.size() : end + 1);
  }
  return out;
}

std::vector<std::string> section_names(const ShotVocabulary& vocabulary) {
  std::vector<std::string> out = {"shot", "primary"};
  for (const SecondarySection* section : vocabulary.sections) out.emplace_back(section->name());
  for (const char* name : {"standin", "wind", "solver", "cache", "gate"}) out.emplace_back(name);
  return out;
}

bool is_named_section(const ShotVocabulary& vocabulary, std::string_view section) {
  return section == "primary" || section == "standin" ||
         std::any_of(vocabulary.sections.begin(), vocabulary.sections.end(),
                     [&](const SecondarySection* known) { return known->name() == section; });
}

std::string home_of(const ShotVocabulary& vocabulary, std::string_view key) {
  std::string home;
  for_each_plain_section([&](std::string_view section, auto keys) {
    for (const auto& k : keys)
      if (k.name == key && home.empty()) home = std::string("[").append(section).append("]");
  });
  const auto look_in = [&](std::string_view section, const auto& keys) {
    for (const auto& k : keys)
      if (k == key && home.empty()) home = std::string("[").append(section).append(".NAME]");
  };
  const auto names = [](auto keys) {
    std::vector<std::string> out;
    for (const auto& k : keys) out.emplace_back(k.name);
    return out;
  };
  look_in("primary", names(primary_keys()));
  look_in("primary", names(prop_keys()));
  look_in("primary", names(yield_keys()));
  for (const SecondarySection* section : vocabulary.sections) look_in(section->name(), section->key_names());
  look_in("standin", names(standin_keys()));
  look_in("wind", names(wind_field_keys()));
  return home;
}

bool is_synonym(std::string_view also, std::string_view word) {
  for (const std::string& other : split_words(also))
    if (edit_distance(other, word) == 0) return true;
  return false;
}

}  // namespace ft::inline io

#include "io/shot/shot_keys.h"

#include "io/shot/words.h"

namespace ft {

std::span<const ShotKey<Shot>> shot_keys() {
  static const ShotKey<Shot> keys[] = {
      {"frames", FramesKey{}, 0, 9'999'999, "", "", true, "frame_range range start end first last",
       "First and last frame, `\"1001-1121\"`, or one frame"},
      {"fps", &Shot::fps, 1, 240, "1/s", "", false, "frame_rate framerate frames_per_second",
       "Frames per second of the shot"},
      {"preroll", &Shot::preroll, 0, 1000, "frames", "", false, "warmup run_up pre_roll",
       "Frames before the first, in which the bind pose blends into the first frame and the cloth settles; with 0, "
       "cloth "
       "that starts through the body stays there"},
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
      {"unit_scale", &PrimarySpec::unit_scale, 1e-6, 1000, "m per file unit", "", false, "scale units unit",
       "Overrides the unit that the file states; 0.01 for centimetres"},
      {"up", &PrimarySpec::up, 0, 0, "", "y z", false, "up_axis axis", "Up axis, when the file states a wrong one"},
      {"source_fps", &PrimarySpec::source_fps, 1, 10'000, "1/s", "", false, "fps sample_rate",
       "Geometry caches: samples per second; without it the shot's fps"},
      {"body", &PrimarySpec::body, 0, 0, "", "blended capsules", false, "",
       "BVH, which has no body: how one is built around the skeleton"},
      {"height", &PrimarySpec::height, 0.05, 50, "m", "", false, "size",
       "Scales the character so that its bind pose is this tall"},
      {"mass", &PrimarySpec::mass, 1e-3, 1e6, "kg", "", false, "weight",
       "Mass, for the accelerations that its secondaries' forces cause; without it from the body's volume. Two-way "
       "coupling needs it"},
      {"meshes", &PrimarySpec::meshes, 0, 0, "", "", false, "mesh objects",
       "Names of the meshes that make the collider; without it all"},
      {"ignore", &PrimarySpec::ignore, 0, 0, "", "", false, "exclude ignore_parts ignored without",
       "Parts that no cloth meets, where they are in its way: names with `*` and `?`, `[\"hand_*\"]`. `info` of the "
       "character lists its parts"},
      {"teleports", TeleportsKey{}, 0, 9'999'999, "", "", false, "teleport cuts jumps",
       "What is done about a character that jumps to another place between two frames: `\"detect\"` carries the cloth "
       "along, `\"ignore\"` simulates it as motion, `[1041]` names the first frame at each new place"},
  };
  return keys;
}

std::span<const ShotKey<ClothSpec>> cloth_keys() {
  static const ShotKey<ClothSpec> keys[] = {
      {"mesh", &ClothSpec::mesh, 0, 0, "", "", true, "file path garment",
       "Garment as OBJ; caches keep its vertex order"},
      {"fabric", &ClothSpec::fabric, 0, 0, "", "@fabrics", false, "material cloth_type preset",
       "Name of a measured fabric"},
      {"on", &ClothSpec::on, 0, 0, "", "@primaries", false, "primary body collider character wearer parent",
       "The primary that wears it; not needed when there is only one"},
      {"pins", PinsKey{}, 0, 0, "", "", false, "attach attachments constraints hold buttons zips",
       "What holds it to the primary or to a cloth: a list of pins, see below"},
      {"pin", SinglePinKey{}, 0, 0, "", "", false, "pin_group", "Short for one pin: the name of a vertex group"},
      {"maps", MapsKey{}, 0, 0, "", "", false, "map vertex_maps textures paint",
       "What varies over its surface, painted or from a file: a list of maps, see below"},
      {"weld", &ClothSpec::weld, 0, 0.05, "m", "", false, "merge merge_distance",
       "Joins vertices nearer than this (open seams); 0 joins none"},
      {"unit_scale", &ClothSpec::unit_scale, 1e-6, 1000, "m per mesh unit", "", false, "scale units unit",
       "0.01 for a mesh in centimetres"},
      {"up", &ClothSpec::up, 0, 0, "", "y z", false, "up_axis axis", "Up axis of the mesh"},
      {"offset", &ClothSpec::offset, -1000, 1000, "m", "", false, "translate position move",
       "Added after scale and axis"},
      {"faces", &ClothSpec::faces, 0, 0, "", "file triangles", false, "topology polygons triangulate",
       "Faces of the caches: those of the file, or the triangles that they are split into for the simulation"},
      {"rest", &ClothSpec::rest, 0, 0, "", "mesh pattern", false, "rest_shape rest_length rest_lengths",
       "Where rest lengths come from: the `mesh` as it is placed, or the flat `pattern` in `vt`. Without it the "
       "pattern where "
       "the mesh has stitches, else the mesh"},
      {"pattern_scale", &ClothSpec::pattern_scale, 1e-6, 1000, "m per vt unit", "", false, "uv_scale vt_scale",
       "Size of the pattern; 0.01 for a pattern in centimetres"},
      {"sewing_time", &ClothSpec::sewing_time, 0, 100, "s", "", false, "sewing stitch_time closing_time",
       "Seams (`stitch` lines) close in this time from the start of the pre-roll; 0 is half of the pre-roll"},
      {"thickness", &ClothSpec::thickness, 0.5e-3, 10e-3, "m", "", false, "contact_radius collision_distance gap",
       "Contact begins at this distance from the body"},
      {"friction", &ClothSpec::friction, 0, 2, "1", "", false, "mu", "Coulomb coefficient against the body"},
      {"self_friction", &ClothSpec::self_friction, 0, 2, "1", "", false, "", "Coulomb coefficient among cloths"},
      {"self_collision", &ClothSpec::self_collision, 0, 0, "", "", false, "self_contact",
       "Cloth meets itself and other cloths"},
      {"ignores", &ClothSpec::ignores, 0, 0, "", "", false, "exclude ignore_parts ignored without",
       "Parts of its primary that this cloth does not meet, beside those that the primary has under `ignore`: names "
       "with `*` and `?`, `[\"hand_*\"]`"},
      {"meets", &ClothSpec::meets, 0, 0, "", "", false, "collides collides_with colliders obstacles",
       "Primaries that this cloth meets beside the one that it is on: names with `*` and `?`; `[]`: no other"},
      {"coupling", &ClothSpec::coupling, 0, 0, "", "one-way hybrid two-way", false, "couple interaction",
       "Who feels whom: `one-way`, it feels the primary; `hybrid`, the primary yields to its stand-ins first; "
       "`two-way` "
       "is for cords"},
  };
  return keys;
}

std::span<const ShotKey<PinSpec>> pin_keys() {
  static const ShotKey<PinSpec> keys[] = {
      {"group", &PinSpec::group, 0, 0, "", "", false, "vertex_group name",
       "All vertices of this group of the mesh (`g` and `o` lines, vertex colours `red`, `green`, `blue`)"},
      {"within", &PinSpec::within, 0, 1, "m", "", false, "distance nearer_than",
       "Vertices nearer than this to the body (with `to`: to that cloth) in the bind pose"},
      {"vertices", PinsKey{}, 0, 0, "", "", false, "points indices",
       "Vertices from 0 in the file's order: `\"0-199, 250\"` or `[0, 1, 2]`"},
      {"file", &PinSpec::file, 0, 0, "", "", false, "weights weight_file map",
       "A weight from 0 to 1 for every vertex of the mesh: text or CSV, a line each; 0 is not held"},
      {"column", &PinSpec::column, 0, 0, "", "", false, "field header", "Column of `file`, where it has several"},
      {"stiffness", &PinSpec::stiffness, 1, 1e12, "N/m3", "", false, "strength",
       "Spring stiffness per area and displacement: 1e5 loose, 1e6 firm, 1e8 hard; not with `to`"},
      {"max_pull", &PinSpec::max_pull, 0, 1e9, "Pa", "", false, "max_force limit",
       "Force limit per area, so that contact wins over pins; not with `to`"},
      {"until", &PinSpec::until, 0, 9'999'999, "frame", "", false, "release release_frame end stop last",
       "Frame at which it lets go; without it never"},
      {"from", &PinSpec::from, 0, 9'999'999, "frame", "", false, "start begin since first",
       "Frame after which it holds, and draws to its place what is elsewhere by then; without it from the start"},
      {"fade", &PinSpec::fade, 0, 100'000, "frames", "", false, "blend ease fade_out release_time",
       "Its force takes so long to vanish after `until` and to grow after `from`; 0 is at once"},
      {"to", &PinSpec::to, 0, 0, "", "@cloths", false, "cloth target garment onto other attach_to button zip",
       "Buttons and zips: holds to this cloth, or to another side of the same, instead of the primary; each vertex to "
       "the nearest point in the bind pose, no farther away than it is there. Both feel it. `world`: to the place "
       "where the mesh has it; the cloth is then not carried along with the primary's start"},
      {"opens", &PinSpec::opens, -1, 1, "", "", false, "open direction unzip opens_from along",
       "A zip: within `fade` its vertices let go one after another in this direction of the bind pose (`[0, -1, 0]` is "
       "down), and take hold the other way round; without it all together"},
  };
  return keys;
}

std::span<const ShotKey<MapSpec>> map_keys() {
  static const ShotKey<MapSpec> keys[] = {
      {"from", &MapSpec::from, 0, 0, "", "", false, "group vertex_group channel colour color",
       "Vertex group of the mesh, or colour channel `red`, `green`, `blue`; weights run from 0 to 1, colours may from "
       "0 to "
       "255"},
      {"file", &MapSpec::file, 0, 0, "", "", false, "values path csv",
       "A number for every vertex of the mesh: text or CSV, a line each; a first line with words names the columns"},
      {"of", &MapSpec::of, 0, 0, "", "@maps", true, "what name kind property target",
       "What varies: factors of the fabric's stiffness (`stretch`, which includes shear; `bend`), `thickness` [m], "
       "`mass_per_area` [kg/m2]"},
      {"column", &MapSpec::column, 0, 0, "", "", false, "field header", "Column of `file`, where it has several"},
      {"low", &MapSpec::low, 0, 0, "", "", false, "min minimum black zero",
       "Value where the weight is 0; linear between"},
      {"high", &MapSpec::high, 0, 0, "", "", false, "max maximum white one",
       "Value where the weight is 1. A file may do without both: its numbers are the values then"},
  };
  return keys;
}

std::span<const ShotKey<WindSpec>> wind_keys() {
  static const ShotKey<WindSpec> keys[] = {
      {"velocity", &WindSpec::velocity, -100, 100, "m/s", "", false, "speed direction",
       "Steady wind, world axes, y up"},
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
  };
  return keys;
}

std::span<const ShotKey<Shot>> gate_keys() {
  static const ShotKey<Shot> keys[] = {
      {"p99_strain", &Shot::gate_p99_strain, 0, 10, "1", "", false, "strain max_strain",
       "Exit code 4 when the 99th percentile of strain is above it; 0 is off"},
      {"crossings", &Shot::gate_crossings, 0, 0, "", "", false, "no_crossings",
       "Exit code 4 when any frame has crossings"},
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

std::vector<std::string> section_names() {
  return {"shot", "primary", "cloth", "cords", "standin", "wind", "solver", "cache", "gate"};
}

bool is_named_section(std::string_view section) {
  bool named = false;
  for_each_named_section([&](std::string_view name, auto) { named = named || name == section; });
  return named;
}

std::string home_of(std::string_view key) {
  std::string home;
  for_each_plain_section([&](std::string_view section, auto keys) {
    for (const auto& k : keys)
      if (k.name == key && home.empty()) home = std::string("[").append(section).append("]");
  });
  for_each_named_section([&](std::string_view section, auto keys) {
    for (const auto& k : keys)
      if (k.name == key && home.empty()) home = std::string("[").append(section).append(".NAME]");
  });
  return home;
}

bool is_synonym(std::string_view also, std::string_view word) {
  for (const std::string& other : split_words(also))
    if (edit_distance(other, word) == 0) return true;
  return false;
}

}  // namespace ft

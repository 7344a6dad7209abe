#include "baker/systems/cloth/cloth_keys.h"

#include "baker/systems/cloth/cloth_grammar.h"

namespace ft::inline baker {
namespace {

std::string no_text(const ClothSpec&, const std::filesystem::path&) {
  return {};
}
std::string no_vertices_text(const PinSpec&, const std::filesystem::path&) {
  return {};
}

}  // namespace

std::span<const ShotKey<ClothSpec>> cloth_keys() {
  static const ShotKey<ClothSpec> keys[] = {
      {"mesh", &ClothSpec::mesh, 0, 0, "", "", true, "file path garment",
       "Garment as OBJ; caches keep its vertex order"},
      {"fabric", &ClothSpec::fabric, 0, 0, "", "@fabrics", false, "material cloth_type preset",
       "Name of a measured fabric"},
      {"on", &ClothSpec::on, 0, 0, "", "@name of a primary or secondary", false,
       "primary body collider character wearer parent",
       "The primary that wears it, or a secondary that is baked before it, `\"cloth.robe\"`; not needed when there is "
       "only one primary"},
      {"pins", OwnGrammar<ClothSpec>{"list of pins", read_pins, pins_text}, 0, 0, "", "", false,
       "attach attachments constraints hold buttons zips",
       "What holds it to the primary or to a cloth: a list of pins, see below"},
      {"pin", OwnGrammar<ClothSpec>{"text", read_single_pin, no_text}, 0, 0, "", "", false, "pin_group",
       "Short for one pin: the name of a vertex group"},
      {"maps", OwnGrammar<ClothSpec>{"list of maps", read_maps, maps_text}, 0, 0, "", "", false,
       "map vertex_maps textures paint",
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
       "pattern where the mesh has stitches, else the mesh"},
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
       "Primaries that this cloth meets beside the one that it is on, and secondaries that are baked before it: names "
       "with `*` and `?`; `[]`: no other. `\"cloth.robe\"` in full has that robe baked before it"},
      {"coupling", &ClothSpec::coupling, 0, 0, "", "one-way hybrid two-way", false, "couple interaction",
       "Who feels whom: `one-way`, it feels the primary; `hybrid`, the primary yields to its stand-ins first; "
       "`two-way` is for cords"},
  };
  return keys;
}

std::span<const ShotKey<PinSpec>> pin_keys() {
  static const ShotKey<PinSpec> keys[] = {
      {"group", &PinSpec::group, 0, 0, "", "", false, "vertex_group name",
       "All vertices of this group of the mesh (`g` and `o` lines, vertex colours `red`, `green`, `blue`)"},
      {"within", &PinSpec::within, 0, 1, "m", "", false, "distance nearer_than",
       "Vertices nearer than this to the body (with `to`: to that cloth) in the bind pose"},
      {"vertices", OwnGrammar<PinSpec>{"vertices", read_pin_vertices, no_vertices_text}, 0, 0, "", "", false,
       "points indices", "Vertices from 0 in the file's order: `\"0-199, 250\"` or `[0, 1, 2]`"},
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
      {"to", &PinSpec::to, 0, 0, "", "@name of a cloth", false, "cloth target garment onto other attach_to button zip",
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
       "0 to 255"},
      {"file", &MapSpec::file, 0, 0, "", "", false, "values path csv",
       "A number for every vertex of the mesh: text or CSV, a line each; a first line with words names the columns"},
      {"of", &MapSpec::of, 0, 0, "", "@`stretch`, `bend`, `thickness`, `mass_per_area`", true,
       "what name kind property target",
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

}  // namespace ft::inline baker

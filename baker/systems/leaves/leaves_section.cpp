#include "baker/systems/leaves/leaves_section.h"

#include "baker/systems/interface/section_of.h"
#include "io/shot/choice_keys.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

std::span<const ShotKey<LeavesSpec>> leaves_keys() {
  static const ShotKey<LeavesSpec> keys[] = {
      {"count", &LeavesSpec::count, 1, 1'000'000, "", "", false, "number amount leaves", "How many are scattered"},
      {"seed", &LeavesSpec::seed, 0, 2'147'483'647, "", "", false, "random", "Of what is drawn by lot"},
      {"over", &LeavesSpec::over, 0, 0, "", "", false, "on_mesh scatter_mesh surface",
       "Scattered over the upper faces of this OBJ, on which they lie; or over a rectangle, by `size`"},
      {"placed", &LeavesSpec::placed, 0, 0, "", "", false, "places points file csv",
       "Or a line for each in a text or CSV file: x, y, z in metres, and as one likes heading in degrees and scale"},
      {"position", &LeavesSpec::position, -1e4, 1e4, "m", "", false, "centre center offset place",
       "Centre of the rectangle; added to a mesh and to places"},
      {"size", &LeavesSpec::size, 0, 1e4, "m", "", false, "region area extents",
       "x and z of the rectangle; with y above 0 they hang in the air over it, up to that height, and fall"},
      {"mesh", &LeavesSpec::mesh, 0, 0, "", "", false, "leaf shape prototype",
       "A leaf as OBJ in metres, at most 64 vertices, x along its rib, y up; without it an almond of `length` and "
       "`width`"},
      {"length", &LeavesSpec::length, 0.005, 2, "m", "", false, "", "Of a leaf, along its rib"},
      {"width", &LeavesSpec::width, 0.002, 2, "m", "", false, "", "Of a leaf"},
      {"fold", &LeavesSpec::fold, 0, 60, "degrees", "", false, "crease bend",
       "By which its two halves rise from the rib"},
      {"variation", &LeavesSpec::variation, 0, 0.9, "1", "", false, "size_variation randomness",
       "Of lengths, and of masses by area, evenly up and down"},
      {"mass_per_area", &LeavesSpec::mass_per_area, 0.005, 5, "kg/m2", "", false, "mass density weight",
       "0.08 is a dry oak leaf, 0.16 to 0.24 a fresh one"},
      {"friction", &LeavesSpec::friction, 0, 2, "1", "", false, "mu", "Coulomb coefficient"},
      {"lift", &LeavesSpec::lift, 0, 2, "1", "", false, "suction lying_lift",
       "Of a lying leaf, by its area and the dynamic pressure of the wind over it: 0.4 lets a dry one go at 1.6 m/s, "
       "which "
       "is what a gentle breeze leaves at the ground"},
      {"adhesion", &LeavesSpec::adhesion, 0, 100, "N/m2", "", false, "stickiness wetness",
       "Holds a lying leaf down: 0.1 dry, 2 to 5 wet"},
      {"near", &LeavesSpec::near, 0, 1e4, "m", "", false, "near_distance lod mesh_distance",
       "Leaves that start so near to `camera` bend along their rib and across, and are one mesh in the caches, "
       "`NAME_near`; all others are rigid, and instances"},
      {"camera", &LeavesSpec::camera, -1e4, 1e4, "m", "", false, "camera_position eye",
       "From where `near` is measured: the camera where it comes nearest"},
      {"bending", &LeavesSpec::bending, 1e-8, 10, "N m", "", false, "bending_stiffness stiffness",
       "Bending stiffness of near leaves: 1e-4 a crisp dry leaf, 2e-5 a limp one"},
      {"meets", &LeavesSpec::meets, 0, 0, "", "", false, "collides collides_with colliders obstacles",
       "Primaries that they meet beside the one that they are on: names with `*` and `?`; `[]`: no other. Water by its "
       "own "
       "name, `water.NAME`: it is baked before, and they float on it"},
      {"on", &LeavesSpec::on, 0, 0, "", "@name of a primary", false, "primary ground",
       "The primary on which they lie; not needed when there is only one"},
  };
  return keys;
}

class LeavesSection final : public SectionOf<LeavesSpec> {
 public:
  LeavesSection() : SectionOf("leaves", leaves_keys()) {}

  void judge(const Value& root, SecondarySpec& spec, const Shot&, FaultList& faults) const override {
    const Value* table = section_of(root, name(), spec.name);
    if (!table) return;
    const auto& own = of(spec);
    const Member *over = table->find("over"), *placed = table->find("placed"), *size = table->find("size");
    const int ways = (over ? 1 : 0) + (placed ? 1 : 0) + (size ? 1 : 0);
    if (ways != 1)
      faults.add(table->place, spec.owner() + (ways == 0 ? ": over, placed or size is missing; one says where they lie"
                                                         : ": has more than one of over, placed and size"));
    if (size && !(own.size.x() > 0 && own.size.z() > 0))
      faults.add(size->value.place, spec.owner() + ": size has no area: x and z are above 0");
    if (const Member* count = table->find("count"); count && placed)
      faults.add(count->place, spec.owner() + ": count does not go with placed, which has a line for each");
    const Member *near = table->find("near"), *camera = table->find("camera");
    if (near && own.near > 0 && !camera)
      faults.add(near->place, spec.owner() + ": near is measured from camera, which is missing");
    if (const Member* only = camera ? camera : table->find("bending"); only && !(own.near > 0))
      faults.add(only->place, spec.owner() + ": " + only->key + " is for near leaves, and near is missing");
    for (const char* key : {"length", "width", "fold"})
      if (const Member* member = table->find(key); member && table->find("mesh"))
        faults.add(member->place, spec.owner() + ": " + key + " does not go with mesh");
  }
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const override {
    return {{"over", of(spec).over}, {"placed", of(spec).placed}, {"mesh", of(spec).mesh}};
  }
  std::vector<std::string> system_names(const SecondarySpec& spec) const override {
    if (of(spec).near > 0) return {spec.name, of(spec).near_name()};
    return {spec.name};
  }
  std::string_view whom() const override { return "on which they lie"; }
  std::vector<std::string> meets(const SecondarySpec& spec) const override { return of(spec).meets; }
  bool floats() const override { return true; }
  std::string_view why_no_carrier() const override {
    return "its leaves are instances, each too light to carry anything";
  }
  std::string_view why_not_two_way() const override { return "is too light for a primary to feel it"; }
};

}  // namespace

const SecondarySection& leaves_section() {
  static const LeavesSection section;
  return section;
}

}  // namespace ft::inline baker

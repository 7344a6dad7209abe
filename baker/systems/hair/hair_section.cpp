#include "baker/systems/hair/hair_section.h"

#include "baker/systems/interface/section_of.h"
#include "io/shot/choice_keys.h"

namespace ft::inline baker {
namespace {

std::span<const ShotKey<HairSpec>> hair_keys() {
  static const ShotKey<HairSpec> keys[] = {
      {"guides", &HairSpec::guides, 0, 0, "", "", false, "curves file groom strands",
       "Guide strands, root first, on the body as garments lie on it: TressFX (`.tfx`), OBJ lines or a hair mesh "
       "(`.obj`), Alembic curves (`.abc`)"},
      {"scale", &HairSpec::scale, 1e-6, 1e6, "m", "", false, "unit", "Metres per unit of that file"},
      {"position", &HairSpec::position, -1e4, 1e4, "m", "", false, "offset translate", "Added to its places"},
      {"count", &HairSpec::count, 0, 1'000'000, "", "", false, "number guides_count",
       "How many of its strands are solved, evenly chosen; 0: all"},
      {"vertices", &HairSpec::vertices, 4, 200, "", "", false, "points segments resolution",
       "Of each strand, at equal distances"},
      {"tie", &HairSpec::tie, -1e4, 1e4, "m", "", false, "band ponytail_band",
       "Centre of a band, as of a pony-tail: strands that go through it are held from the root to where they leave it"},
      {"tie_radius", &HairSpec::tie_radius, 0, 10, "m", "", false, "band_radius", "Of that band; 0: there is none"},
      {"width", &HairSpec::width, 1e-6, 0.1, "m", "", false, "diameter", "Of a strand as drawn, for the caches"},
      {"radius", &HairSpec::radius, 5e-6, 0.02, "m", "", false, "hair_radius",
       "Of a hair, which its weight and stiffness follow: 30e-6 fine, 50e-6 thick. A strand stands for a lock of them"},
      {"stiffness", &HairSpec::stiffness, 1e-3, 1e6, "1", "", false, "bend_stiffness cohesion",
       "Of bending and twisting, by that of a hair: hairs of a lock that stick together are 2 to 100 times as stiff"},
      {"damping", &HairSpec::damping, 0, 1, "s", "", false, "bend_damping", "Time constant of bending and twisting"},
      {"inner_drag", &HairSpec::drag, 0, 1000, "1/s", "", false, "drag sway_damping",
       "Slows what moves otherwise than its root: 0 swings long, 4 usual, 20 as if wet"},
      {"air_drag", &HairSpec::air_drag, 0, 100, "1/m", "", false, "wind_drag",
       "By the air, for a metre of way: 0.5 among others, 25 a hair alone"},
      {"friction", &HairSpec::friction, 0, 2, "1", "", false, "mu", "Coulomb coefficient on what it lies on"},
      {"thickness", &HairSpec::thickness, 2e-4, 0.1, "m", "", false, "offset_distance contact_distance",
       "How far a strand stays from bodies, where it was not combed nearer"},
      {"meets", &HairSpec::meets, 0, 0, "", "", false, "collides collides_with colliders obstacles",
       "Primaries that it meets beside the one that it is on, and garments that are baked before it, as "
       "`cloth.NAME`: names with `*` and `?`; `[]`: no other"},
      {"on", &HairSpec::on, 0, 0, "", "@name of a primary", false, "primary scalp",
       "The primary on which it grows; not needed when there is only one"},
  };
  return keys;
}

class HairSection final : public SectionOf<HairSpec> {
 public:
  HairSection() : SectionOf("hair", hair_keys()) {}

  void judge(const Value& root, SecondarySpec& spec, const Shot&, FaultList& faults) const override {
    const Value* table = section_of(root, name(), spec.name);
    if (!table) return;
    if (!table->find("guides")) faults.add(table->place, spec.owner() + ": guides are missing");
    const Member *tie = table->find("tie"), *radius = table->find("tie_radius");
    if ((tie == nullptr) != (radius == nullptr))
      faults.add((tie ? tie : radius)->place, spec.owner() + ": tie and tie_radius go together");
  }
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const override {
    return {{"guides", of(spec).guides}};
  }
  std::string_view whom() const override { return "on which it grows"; }
  std::vector<std::string> meets(const SecondarySpec& spec) const override { return of(spec).meets; }
  std::string_view why_no_carrier() const override { return "its strands have no surface"; }
  std::string_view why_not_two_way() const override { return "is too light for a primary to feel it"; }
};

}  // namespace

const SecondarySection& hair_section() {
  static const HairSection section;
  return section;
}

}  // namespace ft::inline baker

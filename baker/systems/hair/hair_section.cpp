#include "baker/systems/hair/hair_section.h"

#include "baker/systems/interface/section_of.h"
#include "io/shot/choice_keys.h"
#include "io/shot/ranges.h"

namespace ft::inline baker {
namespace {

std::span<const ShotKey<HairSpec>> hair_keys() {
  static const ShotKey<HairSpec> keys[] = {
      {"guides", &HairSpec::guides, 0, 0, "", "", false, "curves file groom strands",
       "Guide strands, root first, on the body as garments lie on it: TressFX (`.tfx`), OBJ lines or a hair mesh "
       "(`.obj`), Alembic curves (`.abc`). Or it grows from a region: the keys from `region` to `seed`"},
      {"scale", &HairSpec::scale, 1e-6, 1e6, "m", "", false, "unit",
       "Metres per unit of that file, or of `region_mesh`"},
      {"position", &HairSpec::position, -1e4, 1e4, "m", "", false, "offset translate", "Added to its places"},
      {"count", &HairSpec::count, 0, 1'000'000, "", "", false, "number guides_count",
       "How many of its strands are solved, evenly chosen, or grown; 0: all, or as `density` says"},
      {"leave_out", &HairSpec::leave_out, 0, 0, "", "", false, "without exclude skip_ids",
       "Strands of that file that it goes without, by their numbers from 0: `\"3, 10-12\"`; what hangs wrong in the "
       "preview has its number in messages and caches"},
      {"vertices", &HairSpec::vertices, 4, 200, "", "", false, "points segments resolution",
       "Of each strand, at equal distances"},
      {"region", &HairSpec::region, -1e4, 1e4, "m", "", false, "region_center region_centre grow_at",
       "Middle of a ball: hair grows where the body is in it, thinner towards its rim. On the body as garments lie on "
       "it"},
      {"region_radius", &HairSpec::region_radius, 0, 100, "m", "", false, "grow_radius", "Of that ball"},
      {"region_mesh", &HairSpec::region_mesh, 0, 0, "", "", false, "scalp_mesh cap",
       "Instead of a ball: an OBJ that lies on the body, such as its faces with hair; where its vertices have colours, "
       "hair is as dense as their red"},
      {"density", &HairSpec::density, 1, 1e7, "1/m2", "", false, "guides_density",
       "Guides that grow on a painted square metre"},
      {"length", &HairSpec::length, 1e-3, 10, "m", "", false, "hair_length", "Of what grows"},
      {"length_variation", &HairSpec::length_variation, 0, 0.95, "1", "", false, "length_random",
       "By so much of it what grows is longer or shorter, and strands between guides are shorter: 0.1 a cut, 0.9 wild"},
      {"curl_radius", &HairSpec::curl_radius, 0, 1, "m", "", false, "curl", "0 straight, 0.005 waves, 0.015 locks"},
      {"curl_pitch", &HairSpec::curl_pitch, 1e-3, 10, "m", "", false, "curl_length", "Length of a turn of a curl"},
      {"clump_size", &HairSpec::clump_size, 0, 10, "m", "", false, "clumps clumping lock_size",
       "Distance of locks on the scalp that draw together towards their tips: 0 none, 0.01 fine, 0.04 heavy"},
      {"lift", &HairSpec::lift, 0, 1, "1", "", false, "root_lift",
       "At the root: 0 flat on the body, 1 straight out of it"},
      {"bend", &HairSpec::bend, 1e-3, 100, "m", "", false, "bend_length",
       "Length over which a strand turns to the comb: 0.01 limp, 0.2 a brush"},
      {"volume", &HairSpec::volume, 0, 1, "m", "", false, "fullness",
       "How far above the body its uppermost strands lie"},
      {"comb", &HairSpec::comb, -1, 1, "", "", false, "combed comb_direction", "Where strands go: a direction"},
      {"parting_at", &HairSpec::parting_at, -1e4, 1e4, "m", "", false, "parting part", "A place on a parting"},
      {"parting_along", &HairSpec::parting_along, -1, 1, "", "", false, "parting_direction", "Its direction"},
      {"seed", &HairSpec::seed_number, 0, 1'000'000, "", "", false, "random_seed", "Of all that is drawn by lot"},
      {"strands", &HairSpec::strands, 0, 1'000'000, "", "", false, "children interpolated render_strands",
       "How many more go between the guides, as `NAME_strands`: 20000 for a picture"},
      {"clumping", &HairSpec::clumping, 0, 1, "1", "", false, "clump",
       "Of those: 0 evenly spread, 1 together with their guide at the tip"},
      {"hairs", &HairSpec::hairs, 0, 1e8, "", "", false, "hair_count total_hairs",
       "How many hairs the whole of it stands for, by which its forces on the body are: 100000 a head; 0: as many as "
       "it has strands"},
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
      {"pressure", &HairSpec::pressure, 0, 100, "m2/s2", "", false, "repulsion volume_pressure",
       "With which strands push apart that are denser by half than combed: 0 not at all, 3 springy"},
      {"mutual_drag", &HairSpec::mutual_drag, 0, 1000, "1/s", "", false, "cohesion_drag",
       "Slows what moves otherwise than the strands around it: 0 each for itself, 20 one mass"},
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

/// Guides from a file, or a region to grow from: one of the three.
void judge_source(const Value& table, const HairSpec& spec, FaultList& faults) {
  const Member *guides = table.find("guides"), *mesh = table.find("region_mesh"), *radius = table.find("region_radius"),
               *middle = table.find("region");
  const int sources = (guides != nullptr) + (mesh != nullptr) + (radius != nullptr || middle != nullptr);
  if (sources != 1)
    faults.add(table.place, spec.owner() + (sources == 0 ? ": guides are missing, or a region to grow from"
                                                         : ": guides, region and region_mesh: it has one of them"));
  if ((radius == nullptr) != (middle == nullptr))
    faults.add((radius ? radius : middle)->place, spec.owner() + ": region and region_radius go together");
  const Member *at = table.find("parting_at"), *along = table.find("parting_along");
  if ((at == nullptr) != (along == nullptr))
    faults.add((at ? at : along)->place, spec.owner() + ": parting_at and parting_along go together");
  if (const Member* clumping = table.find("clumping"); clumping && spec.strands == 0)
    faults.add(clumping->place, spec.owner() + ": clumping is of strands between guides, and strands is 0");
  std::vector<int> ids;
  std::string fault;
  if (const Member* out = table.find("leave_out"); out && !parse_vertices(spec.leave_out, ids, fault))
    faults.add(out->place, spec.owner() + ": leave_out: " + fault);
  if (const Member* out = table.find("leave_out"); out && !guides)
    faults.add(out->place, spec.owner() + ": leave_out is of strands of a file, and it grows from a region");
  if (!guides) return;
  for (const char* key : {"density", "length", "curl_radius", "curl_pitch", "clump_size", "lift", "bend", "volume",
                          "comb", "parting_at", "seed"})
    if (const Member* found = table.find(key))
      faults.add(found->place,
                 spec.owner() + ": " + key + " is of what grows from a region; its guides are from a file");
}

class HairSection final : public SectionOf<HairSpec> {
 public:
  HairSection() : SectionOf("hair", hair_keys()) {}

  void judge(const Value& root, SecondarySpec& spec, const Shot&, FaultList& faults) const override {
    const Value* table = section_of(root, name(), spec.name);
    if (!table) return;
    judge_source(*table, static_cast<const HairSpec&>(spec), faults);
    const Member *tie = table->find("tie"), *radius = table->find("tie_radius");
    if ((tie == nullptr) != (radius == nullptr))
      faults.add((tie ? tie : radius)->place, spec.owner() + ": tie and tie_radius go together");
  }
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const override {
    std::vector<std::pair<std::string, std::filesystem::path>> out;
    if (!of(spec).guides.empty()) out.emplace_back("guides", of(spec).guides);
    if (!of(spec).region_mesh.empty()) out.emplace_back("region_mesh", of(spec).region_mesh);
    return out;
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

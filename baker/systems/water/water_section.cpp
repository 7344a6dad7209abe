#include "baker/systems/water/water_section.h"

#include "baker/systems/interface/section_of.h"
#include "io/shot/choice_keys.h"

namespace ft::inline baker {
namespace {

std::span<const ShotKey<WaterSpec>> water_keys() {
  static const ShotKey<WaterSpec> keys[] = {
      {"model", &WaterSpec::model, 0, 0, "", "shallow pond paper", false, "type solver kind",
       "`shallow`: puddles and shores, which become dry and wet; `pond`: deep water, where long waves are faster than "
       "short ones; `paper`: columns joined by pipes, after O'Brien and Hodgins (1995), for ripples, and wrong where "
       "water rushes. Without it the one that its depth and size advise, and a note says why; never `paper`"},
      {"position", &WaterSpec::position, -1e4, 1e4, "m", "", true, "center centre place location level",
       "Middle of the still surface"},
      {"size", &WaterSpec::size, 0, 1e4, "m", "", true, "extents dimensions width",
       "Along x and z; the number between is not used"},
      {"depth", &WaterSpec::depth, 0, 1e4, "m", "", false, "water_depth",
       "Of the still water over level ground; not where `bed` says it"},
      {"bed", &WaterSpec::bed, 0, 0, "", "", false, "ground terrain floor_mesh",
       "Ground under `shallow` and `paper` water, an OBJ in the world: its uppermost surface; where it is above the "
       "water it is dry"},
      {"cell", &WaterSpec::cell, 0, 100, "m", "", false, "cell_size resolution grid_size dx",
       "Of the grid: 0.01 a puddle with feet in it, 0.05 a pool; 0: chosen from size and depth"},
      {"edges", &WaterSpec::edges, 0, 0, "", "wall open drain", false, "boundary border sides",
       "Of the rectangle: `wall` sends waves back, `open` lets them leave; `drain`, over a bed: what can run off "
       "over the edge has run off before the shot, so that puddles are left"},
      {"roughness", &WaterSpec::roughness, 0, 0.2, "s/m^(1/3)", "", false, "manning friction",
       "Of the ground under `shallow` and `paper` water, Manning's: 0.010 glass, 0.013 concrete, 0.03 gravel"},
      {"splash", &WaterSpec::splash, 0, 4, "1", "", false, "spray droplets",
       "How much flies, by what theory says: 0 none, and no cache of it, 1 as it is, 2 a show"},
      {"cavity", &WaterSpec::cavity, 0, 10, "1", "", false, "dive_splash entry",
       "Of a pond: how fast the air behind what dives in widens, by that of a clean entry: 1 clean, 5 a bad one"},
      {"floats", &WaterSpec::floats, 0, 0, "", "", false, "floating bodies bobs",
       "Primaries that it moves and that move it: rigid props with `mass`; names with `*` and `?`"},
      {"float_drag", &WaterSpec::float_drag, 0, 10, "1", "", false, "drag",
       "Drag coefficient of what floats: 0.47 a ball, 1 a box"},
      {"seed", &WaterSpec::seed, 0, 1'000'000, "", "", false, "random_seed", "Of all that is drawn by lot"},
      {"meets", &WaterSpec::meets, 0, 0, "", "", false, "collides collides_with colliders obstacles",
       "Primaries that go through it: names with `*` and `?`; `[]`: none"},
      {"coupling", &WaterSpec::coupling, 0, 0, "", "one-way hybrid", false, "mode",
       "With the primary that it is on: `hybrid` where that yields to a stand-in for the water before it is baked"},
      {"on", &WaterSpec::on, 0, 0, "", "@name of a primary", false, "primary",
       "The primary under which it is listed; without it the first"},
  };
  return keys;
}

class WaterSection final : public SectionOf<WaterSpec> {
 public:
  WaterSection() : SectionOf("water", water_keys()) {}

  void judge(const Value& root, SecondarySpec& spec, const Shot&, FaultList& faults) const override {
    const Value* table = section_of(root, name(), spec.name);
    if (!table) return;
    const WaterSpec& own = of(spec);
    const auto fault = [&](const Member* member, const std::string& what) {
      faults.add(member ? member->place : table->place, spec.owner() + ": " + what);
    };
    const Member *depth = table->find("depth"), *bed = table->find("bed"), *size = table->find("size");
    if (size && !(own.size.x() > 0 && own.size.z() > 0)) fault(size, "size has no area: x and z are above 0");
    if (!depth && !bed) fault(nullptr, "depth is missing, or the bed that says how deep it is");
    if (depth && bed) fault(depth, "depth does not go with bed, which says how deep it is");
    if (depth && !(own.depth > 0)) fault(depth, "depth is 0: there is no water");
    if (bed && own.model == "pond")
      fault(bed, "bed is for shallow water and that of the paper; a pond is equally deep everywhere");
    if (const Member* edges = table->find("edges"); edges && own.edges == "drain" && !bed)
      fault(edges, "edges = \"drain\" leaves no water on level ground: it needs a bed that holds some back");
    if (const Member* roughness = table->find("roughness"); roughness && own.model == "pond")
      fault(roughness, "roughness is of the ground under shallow water");
    if (const Member* drag = table->find("float_drag"); drag && own.floats.empty())
      fault(drag, "float_drag is of what floats, and floats is empty");
  }
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const override {
    return {{"bed", of(spec).bed}};
  }
  std::vector<std::string> system_names(const SecondarySpec& spec) const override {
    if (!(of(spec).splash > 0)) return {spec.name};
    return {spec.name, of(spec).droplets_name()};
  }
  std::string_view whom() const override { return "under which primary it is listed"; }
  bool needs_on() const override { return false; }
  bool is_liquid() const override { return true; }
  std::vector<std::string> meets(const SecondarySpec& spec) const override { return of(spec).meets; }
  std::vector<std::string> moves(const SecondarySpec& spec) const override { return of(spec).floats; }
  std::string_view why_not_two_way() const override {
    return "feels those primaries two-way that its key floats names";
  }
};

}  // namespace

const SecondarySection& water_section() {
  static const WaterSection section;
  return section;
}

}  // namespace ft::inline baker

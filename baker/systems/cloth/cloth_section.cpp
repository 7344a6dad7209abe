#include "baker/systems/cloth/cloth_section.h"

#include <algorithm>
#include <cmath>

#include "baker/systems/cloth/cloth_keys.h"
#include "baker/systems/cloth/cloth_maps.h"
#include "baker/systems/interface/section_of.h"
#include "io/shot/shot_judge.h"
#include "io/shot/words.h"
#include "solvers/energies/fabric.h"

namespace ft::inline baker {
namespace {

/// Pins that hold to a cloth: only what one primary wears is solved together.
void judge_attachments(const Value& root, const ClothSpec& cloth, const Shot& shot, FaultList& faults) {
  const auto cloths = specs_of<ClothSpec>(shot.secondaries);
  const Place place = place_of(root, {"cloth", cloth.name, "pins"});
  std::vector<std::string> names;
  for (const ClothSpec* other : cloths) names.push_back(other->name);
  for (const PinSpec& pin : cloth.pins) {
    if (pin.to.empty() || pin.to == k_pin_world) continue;
    const std::string fault = "cloth " + in_quotes(cloth.name) + ": to = " + in_quotes(pin.to);
    const auto held = std::find(names.begin(), names.end(), pin.to) - names.begin();
    if (held == std::ssize(names))
      faults.add(place, with_hint(fault + " names no cloth",
                                  std::any_of(shot.primaries.begin(), shot.primaries.end(),
                                              [&](const PrimarySpec& p) { return p.name == pin.to; })
                                      ? "a pin without to holds to the primary"
                                      : suggestion(pin.to, names)));
    else if (cloths[at(held)]->reference() == cloth.on)
      faults.add(place, fault + " is what it is on; a pin without to holds to that");
    else if (cloths[at(held)]->on != cloth.on)
      faults.add(place, fault + " is worn by another primary; only cloths on the same one can hold each other");
    else if (pin.to == cloth.name && pin.select == PinSpec::Select::k_within)
      faults.add(place,
                 fault + " is the cloth itself, to which all of it is near: say which side by group, vertices or file");
  }
}

class ClothSection final : public SectionOf<ClothSpec> {
 public:
  ClothSection() : SectionOf("cloth", cloth_keys()) {}

  void judge(const Value& root, SecondarySpec& spec, const Shot& shot, FaultList& faults) const override {
    judge_attachments(root, of(spec), shot, faults);
  }
  void append_settings(const std::string& section, const SecondarySpec& spec, const std::filesystem::path& folder,
                       Settings& out) const override {
    SectionOf::append_settings(section, spec, folder, out);
    for (const auto& [key, value] : of(spec).fabric_overrides)
      out.emplace_back(std::string(section).append(".").append(key), number_text(value));
  }
  void append_reference(const ShotVocabulary& vocabulary, std::string& out) const override {
    SectionOf::append_reference(vocabulary, out);
    out.append("A cloth may also override numbers of its fabric:\n\n| key | allowed |\n|---|---|\n");
    for (const FabricKey& key : fabric_keys())
      out.append("| `")
          .append(key.key)
          .append("` | ")
          .append(allowed_text(key.lowest, key.highest, key.unit))
          .append(" |\n");
    out.append("\n");
    ft::append_reference(out, "pins = [ { ... } ]", pin_keys(), vocabulary, 4);
    ft::append_reference(out, "maps = [ { ... } ]", map_keys(), vocabulary, 2);
  }
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const override {
    const ClothSpec& cloth = of(spec);
    std::vector<std::pair<std::string, std::filesystem::path>> out{{"mesh", cloth.mesh}};
    for (std::size_t i = 0; i < cloth.maps.size(); ++i)
      out.emplace_back("maps." + std::to_string(i + 1) + ".file", cloth.maps[i].file);
    for (std::size_t i = 0; i < cloth.pins.size(); ++i)
      out.emplace_back("pins." + std::to_string(i + 1) + ".file", cloth.pins[i].file);
    return out;
  }
  std::vector<std::pair<std::string, std::vector<std::string>>> lists() const override {
    std::vector<std::string> names;
    for (const Fabric& fabric : fabrics()) names.push_back(fabric.name);
    return {{"@fabrics", std::move(names)}};
  }
  std::vector<std::string> meets(const SecondarySpec& spec) const override { return of(spec).meets; }
  std::vector<std::string> solved_with(const SecondarySpec& spec) const override {
    std::vector<std::string> out;
    for (const PinSpec& pin : of(spec).pins)
      if (!pin.to.empty() && pin.to != k_pin_world && pin.to != spec.name) out.push_back(pin.to);
    return out;
  }
  std::string_view whom() const override { return "who wears it"; }
  std::string_view why_not_two_way() const override {
    return "is for cords so far: cloth is not stepped together with a primary (hybrid or one-way is)";
  }

 protected:
  /// Numbers of the fabric.
  OtherKeys other_keys(ClothSpec& cloth) const override {
    OtherKeys out;
    for (const FabricKey& key : fabric_keys()) out.names.emplace_back(key.key);
    out.read = [&cloth](const ValueReader& reader, const Member& member) {
      for (const FabricKey& key : fabric_keys()) {
        if (key.key != member.key) continue;
        if (const auto value = reader.number(member.value, {key.lowest, key.highest, key.unit}))
          cloth.fabric_overrides.emplace_back(key.key, *value);
        return true;
      }
      return false;
    };
    return out;
  }
};

}  // namespace

const SecondarySection& cloth_section() {
  static const ClothSection section;
  return section;
}

}  // namespace ft::inline baker

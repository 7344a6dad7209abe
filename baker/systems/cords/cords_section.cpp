#include "baker/systems/cords/cords_section.h"

#include "baker/systems/cords/cords_keys.h"
#include "baker/systems/interface/section_of.h"
#include "io/shot/choice_keys.h"

namespace ft::inline baker {
namespace {

constexpr ChoiceKeys k_cords_shapes[] = {
    {"net", "", "columns rows radius_top radius_bottom length"},
    {"rope", "to", "held"},
    {"knots", "to", "knots knot_mass held"},
    {"mesh", "mesh", "unit_scale up held"},
};

constexpr double k_most_cords = 1e6;

/// Fills in what depends on its shape: where it is held, and in how many pieces.
void judge_cords(const Value& table, CordsSpec& cords, FaultList& faults) {
  const std::string owner = "cords " + in_quotes(cords.name);
  judge_choice(owner, table, "shape", cords.shape, k_cords_shapes, faults);
  const bool line = cords.shape == "rope" || cords.shape == "knots";
  const Member *held = table.find("held"), *knot_mass = table.find("knot_mass"), *to = table.find("to");
  if (line && held && held->value.kind == Value::Kind::k_text)
    ValueReader{faults, owner, "held"}.is_one_of(held->value, cords.held,
                                                 std::vector<std::string>{"start", "end", "both", "none"});
  if (line && !held) cords.held = "start";
  if (cords.points == 0) cords.points = cords.shape == "net" ? 2 : cords.shape == "rope" ? 32 : line ? 4 : 1;
  const double sides = cords.shape == "net"     ? 2.0 * cords.columns * cords.rows
                       : cords.shape == "knots" ? cords.knots
                                                : 1;
  if (sides * cords.points > k_most_cords)
    faults.add(table.place, owner + ": would be of " + number_text(sides * cords.points) + " pieces, at most " +
                                number_text(k_most_cords) + " are baked");
  if (line && to && cords.to == cords.position)
    faults.add(to->place, owner + ": to is where it starts; its length would be 0");
  if (cords.shape == "knots" && knot_mass && table.find("mass") && cords.knots * cords.knot_mass >= cords.mass)
    faults.add(knot_mass->place, owner + ": its knots weigh " + number_text(cords.knots * cords.knot_mass) +
                                     " kg, and all of it only mass = " + number_text(cords.mass));
}

class CordsSection final : public SectionOf<CordsSpec> {
 public:
  CordsSection() : SectionOf("cords", cords_keys()) {}

  void judge(const Value& root, SecondarySpec& spec, const Shot&, FaultList& faults) const override {
    if (const Value* table = section_of(root, name(), spec.name))
      judge_cords(*table, static_cast<CordsSpec&>(spec), faults);
  }
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const override {
    return {{"mesh", of(spec).mesh}};
  }
  std::string_view whom() const override { return "whom they meet"; }
  bool needs_rigid_primary() const override { return true; }
  std::string_view why_not_two_way() const override { return {}; }
};

}  // namespace

const SecondarySection& cords_section() {
  static const CordsSection section;
  return section;
}

}  // namespace ft::inline baker

#include "baker/systems/follow/follow_section.h"

#include "baker/systems/follow/follow_spec.h"
#include "baker/systems/interface/section_of.h"
#include "io/shot/choice_keys.h"

namespace ft::inline baker {
namespace {

std::span<const ShotKey<FollowSpec>> follow_keys() {
  static const ShotKey<FollowSpec> keys[] = {
      {"bones", &FollowSpec::bones, 0, 0, "", "", false, "joints bone joint",
       "Joints of the character that turn after their animation: names with `*` and `?`, `[\"ear_*\", \"tail*\"]`; "
       "or `weights`"},
      {"weights", &FollowSpec::weights, 0, 0, "", "", false, "file map group points",
       "Or vertices that are displaced together: a number from 0 to 1 for every vertex of the primary, text or CSV"},
      {"column", &FollowSpec::column, 0, 0, "", "", false, "field header", "Column of `weights`, where it has several"},
      {"frequency", &FollowSpec::frequency, 0.05, 60, "Hz", "", false, "stiffness hertz speed",
       "Of the spring: 1 is a slow tail, 3 an ear, 8 a tight strap"},
      {"damping_ratio", &FollowSpec::damping_ratio, 0, 10, "1", "", false, "damping zeta",
       "Of the spring: below 1 it swings over, at 1 it comes back without"},
      {"amount", &FollowSpec::amount, 0, 1, "1", "", false, "weight strength influence",
       "How much of the lag it takes on; 0 is the animation"},
      {"max_angle", &FollowSpec::max_angle, 0, 180, "degrees", "", false, "limit angle_limit",
       "Joints: never farther from the animation"},
      {"max_distance", &FollowSpec::max_distance, 0, 100, "m", "", false, "distance_limit limit_distance",
       "Vertices: never farther from the animation"},
      {"on", &FollowSpec::on, 0, 0, "", "@name of a primary", false, "primary body character",
       "The primary whose joints or vertices they are; not needed when there is only one"},
  };
  return keys;
}

class FollowSection final : public SectionOf<FollowSpec> {
 public:
  FollowSection() : SectionOf("follow", follow_keys()) {}

  void judge(const Value& root, SecondarySpec& spec, const Shot&, FaultList& faults) const override {
    const Value* table = section_of(root, name(), spec.name);
    if (!table) return;
    const Member *bones = table->find("bones"), *weights = table->find("weights");
    if (!bones == !weights)
      faults.add(table->place, spec.owner() + (bones ? ": has both bones and weights; it is one of them"
                                                     : ": bones or weights is missing; they say what follows"));
    if (bones && of(spec).bones.empty() && bones->value.kind == Value::Kind::k_list)
      faults.add(bones->value.place, spec.owner() + ": bones is empty; it names joints of the character");
    for (const auto& [key, other] :
         {std::pair("max_angle", weights), std::pair("max_distance", bones), std::pair("column", bones)})
      if (const Member* member = table->find(key); member && other)
        faults.add(member->place, spec.owner() + ": " + key + " does not go with " + other->key);
  }
  std::vector<std::pair<std::string, std::filesystem::path>> files(const SecondarySpec& spec) const override {
    return {{"weights.file", of(spec).weights}};
  }
  std::vector<std::string> written_files(const SecondarySpec& spec) const override {
    return {spec.name + "_follow.glb", spec.name + "_follow.bvh"};
  }
  std::string_view whom() const override { return "whose joints or vertices they are"; }
  bool needs_character() const override { return true; }
  std::string_view why_no_carrier() const override {
    return "its caches are the body of its primary once more, and cloth on it would meet both; bake what follows in a "
           "shot of its own, and give its cache as a primary";
  }
  std::string_view why_not_two_way() const override { return "is for what has a solver: a primary does not feel it"; }
};

}  // namespace

const SecondarySection& follow_section() {
  static const FollowSection section;
  return section;
}

}  // namespace ft::inline baker

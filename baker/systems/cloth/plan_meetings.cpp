// Which cloths of a shot are solved together, and with which primaries: groups of a plan.
#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/located.h"
#include "baker/plan/meets.h"
#include "baker/systems/cloth/cloth_quality.h"
#include "baker/systems/cloth/meeting.h"
#include "baker/systems/cloth/plan_cloths.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

/// What decides about the cloths of a group that was made by cloths_of().
Status add_reaches(const Shot& shot, const ClothGroup& group, const BakePlan& plan, std::vector<ClothReach>& out) {
  const Eigen::Isometry3d to_start = group.setup.primary->bind_to_start();
  for (const ClothGarment& garment : group.setup.garments) {
    const auto specs = specs_of<ClothSpec>(shot.secondaries);
    const auto found =
        std::find_if(specs.begin(), specs.end(), [&](const ClothSpec* cloth) { return cloth->name == garment.name; });
    CHECK(found != specs.end());
    const ClothSpec* spec = *found;
    auto meets = meets_of(spec->meets, spec->on, plan.primaries);
    if (!meets) return located(meets.error(), shot, spec->owner());
    for (std::size_t p = 0; p < plan.primaries.size(); ++p)
      if (p != group.primary && (!why_alone(plan.shot(), plan.primaries[p]).empty() ||
                                 !why_alone(plan.shot(), plan.primaries[group.primary]).empty()))
        (*meets)[p] = 0;
    const auto holds_always = [](const ClothPin& pin) {
      return pin.to < 0 && !pin.to_world && pin.hold.from == HoldSpan{}.from && pin.hold.until == HoldSpan{}.until;
    };
    const auto in_the_world = [](const ClothPin& pin) { return pin.to_world; };
    const auto& pins = garment.pins;
    const bool moved = std::none_of(pins.begin(), pins.end(), in_the_world);
    Box start;
    for (const Vec3& x : garment.mesh.positions) start.include(moved ? (to_start * x).eval() : x);
    out.push_back(
        {garment.name, group.primary, start, std::none_of(pins.begin(), pins.end(), holds_always), std::move(*meets)});
  }
  return {};
}

/// Adds the cloths of `other` to a group.
void merge_cloths(ClothGroup&& other, ClothGroup& group) {
  const int first = static_cast<int>(group.setup.garments.size());
  for (std::size_t g = 0; g < other.outputs.size(); ++g) {
    for (ClothPin& pin : other.setup.garments[g].pins)
      if (pin.to >= 0) pin.to += first;
    group.setup.garments.push_back(std::move(other.setup.garments[g]));
    group.outputs.push_back(std::move(other.outputs[g]));
  }
}

/// Makes several primaries the one body of a group. A garment goes on ignoring what its own keys say, and all of those
/// primaries that it does not meet.
void join_bodies(const Shot& shot, const BakePlan& plan, const Meeting& meeting, std::span<const ClothReach> reaches,
                 ClothGroup& group) {
  std::vector<JointBody::Member> members;
  for (const std::size_t p : meeting.bodies) {
    const PrimaryPlan& primary = plan.primaries[p];
    members.push_back({primary.name, with_quality(shot, group.setup, primary.trajectory), stands_still(shot, primary)});
  }
  group.joint = std::make_shared<const JointBody>(std::move(members));
  group.bodies = meeting.bodies;
  for (std::size_t m = 0; m < group.bodies.size(); ++m) {
    const int first = group.joint->first_part(m), end = group.joint->first_part(m + 1);
    group.setup.bodies.push_back({{first, end - first}, group.joint->members()[m].name});
  }
  for (std::size_t g = 0; g < group.setup.garments.size(); ++g) {
    ClothGarment& garment = group.setup.garments[g];
    const auto reach = std::find_if(reaches.begin(), reaches.end(),
                                    [&](const ClothReach& known) { return known.name == garment.name; });
    CHECK(reach != reaches.end());
    for (std::size_t m = 0; m < group.bodies.size(); ++m) {
      const int first = group.joint->first_part(m), end = group.joint->first_part(m + 1);
      if (group.bodies[m] == group.outputs[g].primary) {
        for (int& part : garment.ignores) part += first;
        garment.wearer = {{first, end - first}, plan.primaries[group.bodies[m]].trajectory->bind_to_start()};
      }
    }
    for (std::size_t m = 0; m < group.bodies.size(); ++m) {
      if (reach->meets[group.bodies[m]] != 0) continue;
      for (int part = group.joint->first_part(m); part < group.joint->first_part(m + 1); ++part)
        garment.ignores.push_back(part);
    }
    std::sort(garment.ignores.begin(), garment.ignores.end());
  }
  group.setup.primary = group.joint;
}

}  // namespace

Result<std::vector<std::unique_ptr<ClothGroup>>> plan_cloths(const Shot& shot, BakePlan& plan) {
  std::vector<std::unique_ptr<ClothGroup>> own, out;
  std::vector<ClothReach> reaches;
  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    auto group = cloths_of(shot, p, plan);
    if (!group) return group.error();
    if (const Status added = add_reaches(shot, **group, plan, reaches); !added) return added.error();
    own.push_back(std::move(*group));
  }
  if (reaches.empty()) return out;
  if (plan.primaries.size() > 1)
    for (const PrimaryPlan& primary : plan.primaries)
      if (const std::string why = why_alone(plan.shot(), primary); !why.empty())
        plan.notes.push_back(
            fmt::format("cloth of others does not meet \"{}\", and its own meets nothing else: {}", primary.name, why));
  for (const Meeting& meeting : find_meetings(shot, plan.primaries, reaches, plan.wind->fastest())) {
    auto made = std::move(own[meeting.wearers[0]]);
    ClothGroup& group = *made;
    for (std::size_t w = 1; w < meeting.wearers.size(); ++w) merge_cloths(std::move(*own[meeting.wearers[w]]), group);
    apply_quality(shot, group.setup);
    // The collider of a sheet and of a prop that stands still is the drawn body itself.
    const PrimaryPlan& first = plan.primaries[meeting.bodies[0]];
    if (meeting.bodies.size() > 1 || has_sheets(group.setup.primary->surface().parts) ||
        (first.prop && stands_still(shot, first))) {
      join_bodies(shot, plan, meeting, reaches, group);
    } else {
      group.setup.primary = with_quality(shot, group.setup, group.setup.primary);
    }
    group.setup.poses = std::make_shared<FeasiblePoses>(group.setup.primary, group.setup.feasible);
    out.push_back(std::move(made));
  }
  return out;
}

}  // namespace ft::inline baker

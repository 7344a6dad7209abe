#include "baker/systems/follow/follow_kind.h"

#include "baker/systems/follow/follow_group.h"
#include "baker/systems/follow/follow_section.h"

namespace ft::inline baker {
namespace {

class FollowKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return follow_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    SystemGroups out;
    std::vector<const FollowGroup*> last(plan.primaries.size(), nullptr);
    for (const FollowSpec* spec : specs_of<FollowSpec>(shot.secondaries))
      for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
        if (plan.primaries[p].name != spec->on) continue;
        auto group = plan_follow(shot, *spec, p, plan, last[p]);
        if (!group) return group.error();
        last[p] = group->get();
        out.push_back(std::move(*group));
      }
    return out;
  }
  /// It meets nothing, and has no lengths that could stretch.
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake&) const override {
    return std::vector<std::unique_ptr<JudgedGroup>>();
  }
  bool shows_body() const override { return true; }
  std::span<const Metric> metrics() const override {
    static const Metric metrics[] = {{"follow_lag", "m", Metric::Merge::k_max},
                                     {"follow_turn", "rad", Metric::Merge::k_max}};
    return metrics;
  }
};

}  // namespace

const SystemKind* follow_kind() {
  static const FollowKind kind;
  return &kind;
}

}  // namespace ft::inline baker

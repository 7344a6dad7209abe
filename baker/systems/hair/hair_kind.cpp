#include "baker/systems/hair/hair_kind.h"

#include "baker/plan/plan_each.h"
#include "baker/record/judge_each.h"
#include "baker/systems/hair/hair_group.h"
#include "baker/systems/hair/hair_section.h"
#include "baker/systems/hair/judge_hair.h"

namespace ft::inline baker {
namespace {

class HairKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return hair_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    return plan_each<HairSpec>(shot, plan,
                               [&](const HairSpec& spec, std::size_t p) { return plan_hair(shot, spec, p, plan); });
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const override {
    // A mesh that rides on its strands is where they are.
    return judge_each(
        bake, name(), [](const ManifestSystem& system) { return system.shape == OutputShape::k_curves; },
        [&](const ManifestSystem& system) { return judged_hair(bake, system); });
  }
  std::uint32_t colour() const override { return 0x4a2f1d; }
  std::span<const Metric> metrics() const override {
    static const Metric metrics[] = {{"hair_steps", "", Metric::Merge::k_max},
                                     {"hair_iterations", "", Metric::Merge::k_max},
                                     {"hair_unsettled", "", Metric::Merge::k_sum}};
    return metrics;
  }
};

}  // namespace

const SystemKind* hair_kind() {
  static const HairKind kind;
  return &kind;
}

}  // namespace ft::inline baker

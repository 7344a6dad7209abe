#include "baker/systems/hair/hair_kind.h"

#include "baker/systems/hair/hair_group.h"
#include "baker/systems/hair/hair_section.h"
#include "baker/systems/hair/judge_hair.h"

namespace ft::inline baker {
namespace {

class HairKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return hair_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    SystemGroups out;
    for (const HairSpec* spec : specs_of<HairSpec>(shot.secondaries))
      for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
        if (plan.primaries[p].name != spec->on) continue;
        auto group = plan_hair(shot, *spec, p, plan);
        if (!group) return group.error();
        out.push_back(std::move(*group));
      }
    return out;
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const override {
    std::vector<std::unique_ptr<JudgedGroup>> out;
    for (const ManifestSystem& system : bake.manifest.systems) {
      // A mesh that rides on its strands is where they are.
      if (system.role != name() || system.shape != OutputShape::k_curves || !bake.has_cache(system)) continue;
      auto one = judged_hair(bake, system);
      if (!one) return one.error();
      out.push_back(std::move(*one));
    }
    return out;
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

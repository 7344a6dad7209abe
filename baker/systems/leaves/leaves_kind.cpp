#include "baker/systems/leaves/leaves_kind.h"

#include "baker/systems/leaves/judge_leaves.h"
#include "baker/systems/leaves/leaves_group.h"
#include "baker/systems/leaves/leaves_section.h"

namespace ft::inline baker {
namespace {

class LeavesKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return leaves_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    SystemGroups out;
    for (const LeavesSpec* spec : specs_of<LeavesSpec>(shot.secondaries))
      for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
        if (plan.primaries[p].name != spec->on) continue;
        auto groups = plan_leaves(shot, *spec, p, plan);
        if (!groups) return groups.error();
        for (auto& group : *groups) out.push_back(std::move(group));
      }
    return out;
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const override {
    std::vector<std::unique_ptr<JudgedGroup>> out;
    for (const ManifestSystem& system : bake.manifest.systems) {
      if (system.role != name() || !bake.has_cache(system)) continue;
      auto one = judged_leaves(bake, system);
      if (!one) return one.error();
      out.push_back(std::move(*one));
    }
    return out;
  }
  bool is_sheet() const override { return true; }
  std::uint32_t colour() const override { return 0xb87333; }  // of dry ones
  std::span<const Metric> metrics() const override {
    static const Metric metrics[] = {
        {"leaves_awake", "", Metric::Merge::k_sum},      {"leaves_lifted", "", Metric::Merge::k_sum},
        {"leaves_woken", "", Metric::Merge::k_sum},      {"leaves_brought_out", "", Metric::Merge::k_sum},
        {"leaves_fastest", "m/s", Metric::Merge::k_max}, {"leaf_steps", "", Metric::Merge::k_sum},
        {"leaves_afloat", "", Metric::Merge::k_sum}};
    return metrics;
  }
};

}  // namespace

const SystemKind* leaves_kind() {
  static const LeavesKind kind;
  return &kind;
}

}  // namespace ft::inline baker

#include "baker/systems/water/water_kind.h"

#include "baker/plan/plan_each.h"
#include "baker/record/judge_each.h"
#include "baker/systems/water/judge_water.h"
#include "baker/systems/water/water_group.h"
#include "baker/systems/water/water_section.h"

namespace ft::inline baker {
namespace {

class WaterKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return water_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    return plan_each<WaterSpec>(shot, plan,
                                [&](const WaterSpec& spec, std::size_t p) { return plan_water(shot, spec, p, plan); });
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const override {
    return judge_each(
        bake, name(), [](const ManifestSystem&) { return true; },
        [&](const ManifestSystem& system) { return judged_water(bake, system); });
  }
  bool is_sheet() const override { return true; }
  std::uint32_t colour() const override { return 0x2a6f8f; }
  std::span<const Metric> metrics() const override {
    static const Metric metrics[] = {
        {"water_volume", "m3", Metric::Merge::k_sum},   {"water_error", "", Metric::Merge::k_max},
        {"water_airborne", "m3", Metric::Merge::k_sum}, {"water_outflow", "m3", Metric::Merge::k_sum},
        {"water_energy", "J", Metric::Merge::k_sum},    {"water_droplets", "", Metric::Merge::k_sum},
        {"water_fastest", "m/s", Metric::Merge::k_max}, {"water_steps", "", Metric::Merge::k_sum}};
    return metrics;
  }
};

}  // namespace

const SystemKind* water_kind() {
  static const WaterKind kind;
  return &kind;
}

}  // namespace ft::inline baker

#include "baker/systems/water/water_kind.h"

#include "baker/systems/water/judge_water.h"
#include "baker/systems/water/water_group.h"
#include "baker/systems/water/water_section.h"

namespace ft::inline baker {
namespace {

class WaterKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return water_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    SystemGroups out;
    for (const WaterSpec* spec : specs_of<WaterSpec>(shot.secondaries))
      for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
        if (plan.primaries[p].name != spec->on) continue;
        auto group = plan_water(shot, *spec, p, plan);
        if (!group) return group.error();
        out.push_back(std::move(*group));
      }
    return out;
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const override {
    std::vector<std::unique_ptr<JudgedGroup>> out;
    for (const ManifestSystem& system : bake.manifest.systems) {
      if (system.role != name() || !bake.has_cache(system)) continue;
      auto one = judged_water(bake, system);
      if (!one) return one.error();
      out.push_back(std::move(*one));
    }
    return out;
  }
  bool is_liquid() const override { return true; }
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
